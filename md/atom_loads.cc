#include "md/atom_loads.h"

#include "core/check.h"
#include "packings/outer_face.h"

#include <fmt/format.h>

#include <array>
#include <map>

namespace ligament::md
{
template <int dim>
AtomLoads<dim>::AtomLoads(const packings::Packing<dim> &packing, double stiffness,
                          std::vector<core::BoundaryLoad<dim>> loads)
    : loads_(std::move(loads)), displacement_(loads_.size(), Vector<dim>::Zero()),
      traction_(displacement_), reaction_(displacement_)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  for (auto &component : stiffness_)
    component.assign(packing.size(), 0.);
  // Of component c of atom i on a side: the loads that hold it, and how much of the atom's share of
  // the side's area they hold already, m^2.
  std::map<std::array<int, 3>, std::vector<int>> holders;
  std::map<std::array<int, 3>, double> held;
  const auto for_each_face_of = [&](int l, auto &&visit) {
    for (const auto &face : packing.boundary_faces)
      if (face.boundary == loads_[l].boundary)
        if (const auto inside = packings::OuterFace<dim>(face, packing).inside({loads_[l].part}))
          visit(face, inside->area);
  };
  for (int l = 0; l < int(loads_.size()); ++l) {
    core::require(!loads_[l].pressure,
                  fmt::format("/loads/{}: pressures follow faces, which atoms have not; give a "
                              "traction",
                              l));
    if (loads_[l].kind == Kind::velocity || loads_[l].kind == Kind::displacement)
      for_each_face_of(l, [&](const packings::BoundaryFace<dim> &face, double area) {
        const int i = face.i;
        for (int c = 0; c < dim; ++c)
          if (loads_[l].value[c]) {
            holders[{i, c, face.boundary}].push_back(l);
            // Parts of a side that meet share the atoms there.
            double &sum = held[{i, c, face.boundary}];
            sum += area;
            core::require(sum <= face.area * (1 + 1e-6),
                          fmt::format("two loads prescribe component {} of an atom on boundary {}",
                                      c, loads_[l].boundary));
            springs_.push_back({i, c, l, stiffness * area});
            stiffness_[c][i] += stiffness * area;
          }
      });
  }
  for (int l = 0; l < int(loads_.size()); ++l)
    if (loads_[l].kind == Kind::traction)
      for_each_face_of(l, [&](const packings::BoundaryFace<dim> &face, double area) {
        const int i = face.i;
        // Where supports hold a component the traction has none: elsewhere on the same atom it has.
        Vector<dim> acting = Vector<dim>::Constant(area);
        for (int c = 0; c < dim; ++c)
          if (const auto by = holders.find({i, c, face.boundary}); by != holders.end())
            for (const int h : by->second)
              if (const auto both = packings::OuterFace<dim>(face, packing)
                                        .inside({loads_[l].part, loads_[h].part}))
                acting[c] -= both->area;
        acting = acting.cwiseMax(0);
        pushes_.push_back({i, l, acting});
      });
}

template <int dim>
void AtomLoads<dim>::set_time(double time)
{
  using Kind = typename core::BoundaryLoad<dim>::Kind;
  for (std::size_t l = 0; l < loads_.size(); ++l)
    if (loads_[l].kind == Kind::traction)
      traction_[l] = loads_[l].traction(time);
    else if (loads_[l].kind != Kind::acceleration)
      for (int c = 0; c < dim; ++c)
        if (loads_[l].value[c])
          displacement_[l][c] = loads_[l].displacement(c, time);
}

template <int dim>
void AtomLoads<dim>::add_forces(Particles &atoms, double time)
{
  if (is_empty())
    return;
  set_time(time);
  std::vector<std::array<core::ExactSum, dim>> reactions(loads_.size());
  for (const Spring &s : springs_) {
    const double f = s.stiffness * stretch(s, atoms);
    atoms.force[s.c][s.i] += f;
    reactions[s.load][s.c].add(f);
    if (is_booked_) {
      const double old = s.stiffness * (old_displacement_[s.load][s.c] - old_[s.c][s.i]);
      const double moved = displacement_[s.load][s.c] - old_displacement_[s.load][s.c];
      if (moved != 0)
        work_.add(0.5 * (f + old) * moved);
    }
  }
  for (const Push &p : pushes_)
    for (int c = 0; c < dim; ++c) {
      const double f = p.area[c] * traction_[p.load][c];
      atoms.force[c][p.i] += f;
      reactions[p.load][c].add(f);
      if (is_booked_)
        work_.add(0.5 * (f + p.area[c] * old_traction_[p.load][c]) *
                  (atoms.displacement[c][p.i] - old_[c][p.i]));
    }
  for (std::size_t l = 0; l < loads_.size(); ++l)
    for (int c = 0; c < dim; ++c)
      reaction_[l][c] = reactions[l][c].value();
  is_booked_ = true;
  old_displacement_ = displacement_;
  old_traction_ = traction_;
  old_ = atoms.displacement;
}

template <int dim>
double AtomLoads<dim>::energy(const Particles &atoms) const
{
  core::ExactSum sum;
  for (const Spring &s : springs_)
    sum.add(0.5 * s.stiffness * stretch(s, atoms) * stretch(s, atoms));
  return sum.value();
}

template <int dim>
Vector<dim> AtomLoads<dim>::reaction(int load) const
{
  return reaction_.empty() ? Vector<dim>(Vector<dim>::Zero()) : reaction_[load];
}

template <int dim>
void AtomLoads<dim>::save(core::State &state, const core::Names &names) const
{
  if (is_empty())
    return;
  core::save_sum(state, "surface_work", work_);
  core::save_value(state, "surface", "booked", std::int64_t(is_booked_));
  if (!is_booked_)
    return;
  std::vector<std::int64_t> numbers;
  for (std::size_t l = 0; l < loads_.size(); ++l)
    numbers.push_back(std::int64_t(l));
  core::Table loads(std::move(numbers));
  for (const auto &[name, values] :
       {std::pair("displacement_", &old_displacement_), std::pair("traction_", &old_traction_)})
    for (int c = 0; c < dim; ++c) {
      std::vector<double> column;
      for (const auto &v : *values)
        column.push_back(v[c]);
      loads.add(name + std::to_string(c), column);
    }
  state["loads"] = std::move(loads);
  core::Table places(names.sorted());
  names.save(places, "displacement", old_);
  state["loaded_atoms"] = std::move(places);
}

template <int dim>
void AtomLoads<dim>::load(const core::State &state, const core::Names &names,
                          const Particles &atoms)
{
  if (is_empty())
    return;
  work_ = core::load_sum(state, "surface_work");
  is_booked_ = core::load_integer(state, "surface", "booked") != 0;
  if (!is_booked_)
    return;
  const core::Table &loads = core::table(state, "loads");
  core::require(loads.n_rows() == loads_.size(), "the state is of another number of loads");
  old_displacement_ = old_traction_ = displacement_;
  for (int c = 0; c < dim; ++c) {
    const auto displacement = loads.reals("displacement_" + std::to_string(c)),
               traction = loads.reals("traction_" + std::to_string(c));
    for (std::size_t l = 0; l < loads_.size(); ++l) {
      old_displacement_[l][c] = displacement[l];
      old_traction_[l][c] = traction[l];
    }
  }
  for (auto &component : old_)
    component.assign(atoms.size(), 0.);
  names.load(core::table(state, "loaded_atoms"), "displacement", old_);
}

template class AtomLoads<2>;
template class AtomLoads<3>;
} // namespace ligament::md
