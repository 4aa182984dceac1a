// Own stresses of particles beside the kernels: as faces break, and where faces divide their motion
// between two materials.
#include "dem/parts/inelastic_strains.h"

#include "dem/bond_law.h"

namespace ligament::dem
{
template <int dim>
auto InelasticStrains<dim>::dot(const Tensor &a, const Tensor &b) -> double
{
  const Tensor product = a.cwiseProduct(b);
  return product.template head<3>().sum() + 2 * product.template tail<n_tensor<dim> - 3>().sum();
}

template <int dim>
auto InelasticStrains<dim>::moved(int i, const Tensor &e) const -> Tensor
{
  Tensor moved = Tensor::Zero();
  if (open_[i] < 0)
    return e;
  const double *const moment = cells_[open_[i]].number + OpenCell<dim>::moment;
  for (int a = 0; a < dim; ++a)
    for (int b = 0; b < dim; ++b)
      for (int c = 0; c < dim; ++c)
        moved[tensor_place<dim>(a, b)] += (a == b ? 1 : 0.5) * e[tensor_place<dim>(a, c)] *
                                          moment[a * n_in_plane<dim> + in_plane_place<dim>(c, b)];
  if (dim == 2)
    moved[2] = e[2];
  return moved;
}

template <int dim>
auto InelasticStrains<dim>::pressed(int i) const -> Tensor
{
  Tensor one = Tensor::Zero();
  one.template head<dim>().setOnes();
  Tensor moment = moved(i, one);
  if (dim == 2)
    moment[2] = body_->is_plane_strain();
  return moment;
}

template <int dim>
double InelasticStrains<dim>::volume(int i) const
{
  return open_[i] >= 0              ? cells_[open_[i]].number[OpenCell<dim>::volume]
         : body_->volumes().empty() ? whole_volume_
                                    : body_->volumes()[i];
}

template <int dim>
auto InelasticStrains<dim>::symmetric(const Matrix &m) -> Tensor
{
  Tensor t = Tensor::Zero();
  for (int a = 0; a < dim; ++a)
    for (int b = a; b < dim; ++b)
      t[tensor_place<dim>(a, b)] = 0.5 * (m(a, b) + m(b, a));
  return t;
}

template <int dim>
auto InelasticStrains<dim>::face_strain(const Bond<dim> &b, int i, const Particles &p,
                                        const Vector<dim> &opening) -> Matrix
{
  const auto turn_i = Turn<dim>::of(p, b.i), turn_j = Turn<dim>::of(p, b.j);
  const BondMotion<dim> m(b, turn_i, turn_j, get(p.displacement, b.i), get(p.displacement, b.j));
  const bool first = b.i == i;
  const Turn<dim> back = (first ? turn_i : turn_j).inverse();
  const Vector<dim> left = m.du - opening, du = first ? left : Vector<dim>(-left),
                    own = du + back.change(du);
  return b.area / b.distance * own * (first ? b.lever_i : b.lever_j).transpose();
}

template <int dim>
auto InelasticStrains<dim>::stress_change(int i, const Matrix &x, double pressure) const -> Tensor
{
  return 2 * laws_[law_number(i)].shear / volume(i) * symmetric(x) + pressure * pressed(i);
}

template <int dim>
auto InelasticStrains<dim>::stress(int i) const -> Tensor
{
  Tensor t = Tensor::Zero();
  if (is_strained(i))
    for (int c = 0; c < n_tensor<dim>; ++c)
      t[c] = streams_.stream(Streams::stress + c)[i];
  return t;
}

template <int dim>
auto InelasticStrains<dim>::stress_of(int i, const Matrix &x, double pressure) const -> Tensor
{
  Tensor flowed = moved(i, tensor(i));
  if (dim == 2 && !body_->is_plane_strain())
    flowed[2] = 0;
  return stress_change(i, x, pressure) - 2 * laws_[law_number(i)].shear * flowed;
}

template <int dim>
bool InelasticStrains<dim>::keeps_stress(int i) const
{
  if (!is_strained(i))
    return false;
  const FlowLaw &law = laws_[law_number(i)];
  return law.kind != FlowLaw::Kind::elastic || law.viscous;
}

template <int dim>
bool InelasticStrains<dim>::knows_stress(int i) const
{
  return keeps_stress(i) && (laws_[law_number(i)].viscous || history(i) > 0 || is_near(i));
}

template <int dim>
void InelasticStrains<dim>::follow_stress(int i, const Tensor &change, const Tensor &strain_before,
                                          const Tensor &viscous_before) const
{
  if (!keeps_stress(i))
    return;
  for (int c = 0; c < n_tensor<dim>; ++c)
    streams_.stream(Streams::stress + c)[i] += change[c];
  const double half = 0.5 * volume(i);
  const Tensor viscous = viscous_strain(i) - viscous_before,
               plastic = tensor(i) - strain_before - viscous;
  streams_.stream(Streams::taken)[i] += half * dot(plastic, change);
  if (is_viscous())
    streams_.stream(Streams::dissipated)[i] += half * dot(viscous, change);
}

template <int dim>
double InelasticStrains<dim>::jump(int i, const Tensor &change, double pressure)
{
  if (!knows_stress(i))
    return 0;
  for (int c = 0; c < n_tensor<dim>; ++c)
    streams_.stream(Streams::stress + c)[i] += change[c];
  return laws_[law_number(i)].viscous ? lose_face(i, volume(i), change, Matrix::Zero(), pressure)
                                      : 0;
}

template <int dim>
double InelasticStrains<dim>::forget_face(const Bond<dim> &b, int i, const Particles &p,
                                          const Vector<dim> &opening, double before, double after)
{
  if (!knows_stress(i))
    return 0;
  const double twice_shear = 2 * laws_[law_number(i)].shear;
  const Matrix lost = moment(b, i) / volume(i);
  const Tensor change = stress_change(i, -face_strain(b, i, p, opening), after - before) +
                        symmetric((twice_shear * strain(i) - before * Matrix::Identity()) * lost);
  for (int c = 0; c < n_tensor<dim>; ++c)
    streams_.stream(Streams::stress + c)[i] += change[c];
  return laws_[law_number(i)].viscous ? lose_face(i, volume(i), change, lost, after) : 0;
}

template <int dim>
void InelasticStrains<dim>::set_other_faces(const std::vector<OtherFace<dim>> &faces,
                                            const Particles &p)
{
  if (!has_law())
    return;
  std::vector<int> changed;
  const auto note = [&] {
    for (const auto &[i, moment] : other_moment_)
      changed.push_back(i);
  };
  note();
  other_moment_.clear();
  for (const auto &face : faces)
    for (const auto &[i, m] : {std::pair(face.i, face.moment_i), std::pair(face.j, face.moment_j)})
      other_moment_.try_emplace(i, Matrix::Zero()).first->second += m;
  note();
  for (const int i : changed)
    set_cell(i, p.volume[i]);
}

template <int dim>
void InelasticStrains<dim>::forget(int i, const Matrix &moment, const Matrix &x, double before,
                                   double after)
{
  if (!knows_stress(i))
    return;
  const Matrix flowed = strain(i) * moment;
  jump(i,
       Tensor(stress_change(i, Matrix(flowed - x), after - before) -
              symmetric(before / volume(i) * moment)),
       after);
}

template class InelasticStrains<2>;
template class InelasticStrains<3>;
} // namespace ligament::dem
