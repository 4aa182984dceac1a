#include "packings/packing_state.h"

#include <numeric>

namespace ligament::packings
{
namespace
{
/// Rows called 0 to n - 1.
core::Table numbered(std::size_t n)
{
  std::vector<std::int64_t> keys(n);
  std::iota(keys.begin(), keys.end(), 0);
  return core::Table(std::move(keys));
}

/// One column of a number that each row has.
template <typename Row, typename Get>
void add_numbers(core::Table &table, const std::string &name, const std::vector<Row> &rows,
                 const Get &get)
{
  using Number = std::conditional_t<std::is_floating_point_v<std::decay_t<decltype(get(rows[0]))>>,
                                    double, std::int64_t>;
  std::vector<Number> values;
  values.reserve(rows.size());
  for (const Row &row : rows)
    values.push_back(Number(get(row)));
  table.add(name, values);
}

template <int dim, typename Row, typename Get>
void add_vectors(core::Table &table, const std::string &name, const std::vector<Row> &rows,
                 const Get &get)
{
  for (int c = 0; c < dim; ++c)
    add_numbers(table, name + "_" + std::to_string(c), rows,
                [&](const Row &row) { return double(get(row)[c]); });
}

template <int dim, typename Row, typename Get>
void read_vectors(const core::Table &table, const std::string &name, std::vector<Row> &rows,
                  const Get &get)
{
  for (int c = 0; c < dim; ++c) {
    const auto values = table.reals(name + "_" + std::to_string(c));
    for (std::size_t r = 0; r < rows.size(); ++r)
      get(rows[r])[c] = std::decay_t<decltype(get(rows[r])[c])>(values[r]);
  }
}

template <typename Row, typename Get>
void read_reals(const core::Table &table, const std::string &name, std::vector<Row> &rows,
                const Get &get)
{
  const auto values = table.reals(name);
  for (std::size_t r = 0; r < rows.size(); ++r)
    get(rows[r]) = values[r];
}

template <typename Row, typename Get>
void read_integers(const core::Table &table, const std::string &name, std::vector<Row> &rows,
                   const Get &get)
{
  const auto values = table.integers(name);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    auto &value = get(rows[r]);
    value = std::decay_t<decltype(value)>(values[r]);
  }
}

std::vector<std::int64_t> wide(const std::vector<int> &values)
{
  return {values.begin(), values.end()};
}

/// One row for each corner; its keys are the number of the face, and its own there.
template <int dim>
core::Table corners_of(const std::vector<BoundaryFace<dim>> &faces)
{
  std::vector<std::int64_t> keys;
  std::vector<Vector<dim>> corners;
  for (std::size_t f = 0; f < faces.size(); ++f)
    for (std::size_t k = 0; k < faces[f].corners.size(); ++k) {
      keys.insert(keys.end(), {std::int64_t(f), std::int64_t(k)});
      corners.push_back(faces[f].corners[k]);
    }
  core::Table table(std::move(keys), 2);
  for (int c = 0; c < dim; ++c) {
    std::vector<double> column;
    for (const Vector<dim> &corner : corners)
      column.push_back(corner[c]);
    table.add("place_" + std::to_string(c), column);
  }
  return table;
}

template <int dim>
void read_corners(const core::Table &table, std::vector<BoundaryFace<dim>> &faces)
{
  std::vector<Vector<dim>> corners(table.n_rows());
  for (int c = 0; c < dim; ++c) {
    const auto column = table.reals("place_" + std::to_string(c));
    for (std::size_t r = 0; r < corners.size(); ++r)
      corners[r][c] = column[r];
  }
  for (std::size_t r = 0; r < corners.size(); ++r)
    faces[std::size_t(table.keys()[2 * r])].corners.push_back(corners[r]);
}
} // namespace

template <int dim>
void save_packing(core::State &state, const RandomPacking<dim> &random)
{
  const Packing<dim> &p = random.packing;
  core::Table cells = numbered(p.volume.size());
  for (int c = 0; c < dim; ++c)
    cells.add("centre_" + std::to_string(c), p.centre[c]);
  cells.add("volume", p.volume);
  cells.add("diameter", p.diameter);
  cells.add("id", p.global_id);
  if (!p.material.empty())
    cells.add("material", wide(p.material));
  state["cells"] = std::move(cells);

  using F = Face<dim>;
  core::Table faces = numbered(p.faces.size());
  add_numbers(faces, "i", p.faces, [](const F &f) { return f.i; });
  add_numbers(faces, "j", p.faces, [](const F &f) { return f.j; });
  add_vectors<dim>(faces, "normal", p.faces, [](const F &f) { return f.normal; });
  add_numbers(faces, "area", p.faces, [](const F &f) { return f.area; });
  add_numbers(faces, "q_i", p.faces, [](const F &f) { return f.q_i; });
  add_numbers(faces, "q_j", p.faces, [](const F &f) { return f.q_j; });
  add_vectors<dim>(faces, "lever_i", p.faces, [](const F &f) { return f.lever_i; });
  add_vectors<dim>(faces, "lever_j", p.faces, [](const F &f) { return f.lever_j; });
  add_numbers(faces, "cracked", p.faces, [](const F &f) { return int(f.cracked); });
  add_numbers(faces, "cut", p.faces, [](const F &f) { return f.cut; });
  if (p.period.maxCoeff() > 0)
    add_vectors<dim>(faces, "image", p.faces, [](const F &f) { return f.image; });
  state["cell_faces"] = std::move(faces);

  using B = BoundaryFace<dim>;
  core::Table outer = numbered(p.boundary_faces.size());
  add_numbers(outer, "i", p.boundary_faces, [](const B &f) { return f.i; });
  add_vectors<dim>(outer, "normal", p.boundary_faces, [](const B &f) { return f.normal; });
  add_numbers(outer, "area", p.boundary_faces, [](const B &f) { return f.area; });
  add_numbers(outer, "q", p.boundary_faces, [](const B &f) { return f.q; });
  add_vectors<dim>(outer, "lever", p.boundary_faces, [](const B &f) { return f.lever; });
  add_numbers(outer, "boundary", p.boundary_faces, [](const B &f) { return f.boundary; });
  state["outer_faces"] = std::move(outer);
  if (dim == 3)
    state["outer_corners"] = corners_of(p.boundary_faces);

  core::Table seeds = numbered(random.seeds.centre.size());
  add_vectors<dim>(seeds, "centre", random.seeds.centre, [](const Vector<dim> &x) { return x; });
  seeds.add("radius", random.seeds.radius);
  seeds.add("id", random.seeds.id);
  if (!random.seeds.material.empty())
    seeds.add("material", wide(random.seeds.material));
  state["seeds"] = std::move(seeds);
  for (int c = 0; c < dim && p.period.maxCoeff() > 0; ++c)
    core::save_value(state, "packing", "period_" + std::to_string(c), p.period[c]);
  core::save_value(state, "packing", "spacing", p.spacing);
  core::save_value(state, "packing", "thickness", p.thickness);
  core::save_value(state, "packing", "n_healed", std::int64_t(random.n_healed));
}

template <int dim>
RandomPacking<dim> load_packing(const core::State &state, const SpecimenParameters<dim> &specimen)
{
  const auto materials = [](const core::Table &table) {
    std::vector<int> material;
    if (table.has("material"))
      for (const std::int64_t m : table.integers("material"))
        material.push_back(int(m));
    return material;
  };
  RandomPacking<dim> random;
  Packing<dim> &p = random.packing;
  const core::Table &cells = core::table(state, "cells");
  for (int c = 0; c < dim; ++c)
    p.centre[c] = cells.reals("centre_" + std::to_string(c));
  p.volume = cells.reals("volume");
  p.diameter = cells.reals("diameter");
  p.global_id = cells.integers("id");
  p.material = materials(cells);

  using F = Face<dim>;
  const core::Table &faces = core::table(state, "cell_faces");
  p.faces.resize(faces.n_rows());
  read_integers(faces, "i", p.faces, [](F &f) -> int & { return f.i; });
  read_integers(faces, "j", p.faces, [](F &f) -> int & { return f.j; });
  read_vectors<dim>(faces, "normal", p.faces, [](F &f) -> Vector<dim> & { return f.normal; });
  read_reals(faces, "area", p.faces, [](F &f) -> double & { return f.area; });
  read_reals(faces, "q_i", p.faces, [](F &f) -> double & { return f.q_i; });
  read_reals(faces, "q_j", p.faces, [](F &f) -> double & { return f.q_j; });
  read_vectors<dim>(faces, "lever_i", p.faces, [](F &f) -> Vector<dim> & { return f.lever_i; });
  read_vectors<dim>(faces, "lever_j", p.faces, [](F &f) -> Vector<dim> & { return f.lever_j; });
  read_integers(faces, "cracked", p.faces, [](F &f) -> bool & { return f.cracked; });
  read_integers(faces, "cut", p.faces, [](F &f) -> int & { return f.cut; });
  if (faces.has("image_0")) {
    read_vectors<dim>(faces, "image", p.faces,
                      [](F &f) -> std::array<int, dim> & { return f.image; });
    for (int c = 0; c < dim; ++c)
      p.period[c] = core::load_real(state, "packing", "period_" + std::to_string(c));
  }
  for (F &face : p.faces)
    face.direction = -1;

  using B = BoundaryFace<dim>;
  const core::Table &outer = core::table(state, "outer_faces");
  p.boundary_faces.resize(outer.n_rows());
  read_integers(outer, "i", p.boundary_faces, [](B &f) -> int & { return f.i; });
  read_vectors<dim>(outer, "normal", p.boundary_faces,
                    [](B &f) -> Vector<dim> & { return f.normal; });
  read_reals(outer, "area", p.boundary_faces, [](B &f) -> double & { return f.area; });
  read_reals(outer, "q", p.boundary_faces, [](B &f) -> double & { return f.q; });
  read_vectors<dim>(outer, "lever", p.boundary_faces,
                    [](B &f) -> Vector<dim> & { return f.lever; });
  read_integers(outer, "boundary", p.boundary_faces, [](B &f) -> int & { return f.boundary; });
  if (dim == 3)
    read_corners(core::table(state, "outer_corners"), p.boundary_faces);

  const core::Table &seeds = core::table(state, "seeds");
  random.seeds.centre.resize(seeds.n_rows());
  read_vectors<dim>(seeds, "centre", random.seeds.centre,
                    [](Vector<dim> &x) -> Vector<dim> & { return x; });
  random.seeds.radius = seeds.reals("radius");
  random.seeds.id = seeds.integers("id");
  random.seeds.material = materials(seeds);
  p.spacing = core::load_real(state, "packing", "spacing");
  p.thickness = core::load_real(state, "packing", "thickness");
  random.n_healed = int(core::load_integer(state, "packing", "n_healed"));
  p.cuts = SpecimenShape<dim>(specimen).cracks;
  return random;
}

template void save_packing(core::State &, const RandomPacking<2> &);
template void save_packing(core::State &, const RandomPacking<3> &);
template RandomPacking<2> load_packing(const core::State &, const SpecimenParameters<2> &);
template RandomPacking<3> load_packing(const core::State &, const SpecimenParameters<3> &);
} // namespace ligament::packings
