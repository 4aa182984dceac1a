#include "dem/plastic_blocks.h"

#include <algorithm>

namespace ligament::dem
{
namespace
{
constexpr int block = TractionScreen::block;
constexpr int n_numbers = 8;
constexpr int n_saved = 7; // strain and history
} // namespace

template <int dim>
PlasticBlocks<dim>::PlasticBlocks(const BondNetwork<dim> &bonds,
                                  std::unique_ptr<const YieldLaw> law,
                                  const std::vector<int> &always)
    : n_(bonds.n_particles()), law_(std::move(law)), plastic_((n_ + block - 1) / block, 0),
      always_blocks_(plastic_.size(), 0), neighbours_(plastic_.size()),
      numbers_(n_numbers * std::size_t(n_), false), turned_(2 * dim * dim * std::size_t(n_), false)
{
  for (const int i : always)
    always_blocks_[i / block] = 1;
  const auto join = [&](int a, int b) {
    auto &of = neighbours_[a];
    if (a != b && std::find(of.begin(), of.end(), b) == of.end())
      of.push_back(b);
  };
  bonds.for_each_bond([&](BondId, const Bond<dim> &b) {
    join(b.i / block, b.j / block);
    join(b.j / block, b.i / block);
  });
}

template <int dim>
std::vector<RowRange>
PlasticBlocks<dim>::with_neighbours(const std::vector<std::uint8_t> &blocks) const
{
  std::vector<RowRange> found;
  for (int b = 0; b < n_blocks(); ++b) {
    const auto &of = neighbours_[b];
    if (blocks[b] || std::any_of(of.begin(), of.end(), [&](int a) { return blocks[a]; }))
      found.push_back({b * block, std::min((b + 1) * block, n_)});
  }
  return found;
}

template <int dim>
std::vector<RowRange> PlasticBlocks<dim>::suspects(const std::vector<std::uint8_t> &marks) const
{
  std::vector<std::uint8_t> all = marks;
  for (int b = 0; b < n_blocks(); ++b)
    all[b] = all[b] || plastic_[b] || always_blocks_[b];
  return with_neighbours(all);
}

template <int dim>
std::vector<RowRange> PlasticBlocks<dim>::around_plastic() const
{
  return with_neighbours(plastic_);
}

template <int dim>
std::vector<RowRange> PlasticBlocks<dim>::plastic() const
{
  std::vector<RowRange> found;
  for (int b = 0; b < n_blocks(); ++b)
    if (plastic_[b])
      found.push_back({b * block, std::min((b + 1) * block, n_)});
  return found;
}

template <int dim>
std::vector<RowRange> PlasticBlocks<dim>::and_neighbours(const std::vector<RowRange> &blocks) const
{
  std::vector<std::uint8_t> chosen(plastic_.size(), 0);
  for (const RowRange &range : blocks)
    chosen[range.begin / block] = 1;
  return with_neighbours(chosen);
}

template <int dim>
int PlasticBlocks<dim>::n_plastic_blocks() const
{
  return int(std::count(plastic_.begin(), plastic_.end(), 1));
}

template <int dim>
Tensor PlasticBlocks<dim>::tensor(int i) const
{
  Tensor t = Tensor::Zero();
  if (is_plastic(i))
    for (int c = 0; c < 6; ++c)
      t[c] = number(c)[i];
  return t;
}

template <int dim>
typename PlasticBlocks<dim>::Matrix PlasticBlocks<dim>::strain(int i) const
{
  if (!is_plastic(i))
    return Matrix::Zero();
  const auto e = [&](int c) { return number(c)[i]; };
  Matrix m;
  if constexpr (dim == 2)
    m << e(0), e(5), e(5), e(1);
  else
    m << e(0), e(5), e(4), e(5), e(1), e(3), e(4), e(3), e(2);
  return m;
}

template <int dim>
void PlasticBlocks<dim>::add(int i, const Tensor &increment)
{
  plastic_[i / block] = 1;
  for (int c = 0; c < 6; ++c)
    number(c)[i] += increment[c];
}

template <int dim>
void PlasticBlocks<dim>::save(core::State &state, const core::Names &names) const
{
  std::vector<std::int64_t> keys;
  std::array<std::vector<double>, n_saved> values;
  for (const int i : names.ascending())
    if (is_plastic(i)) {
      keys.push_back(names.name(i));
      for (int k = 0; k < n_saved; ++k)
        values[k].push_back(number(k)[i]);
    }
  core::Table table(std::move(keys));
  for (int k = 0; k < n_saved; ++k)
    table.add("number_" + std::to_string(k), values[k]);
  state["plastic"] = std::move(table);
}

template <int dim>
void PlasticBlocks<dim>::load(const core::State &state, const core::Names &names)
{
  const core::Table &table = core::table(state, "plastic");
  for (int k = 0; k < n_saved; ++k) {
    const auto values = table.reals("number_" + std::to_string(k));
    for (std::size_t r = 0; r < table.n_rows(); ++r)
      if (const int i = names.index(table.keys()[r]); i >= 0) {
        plastic_[i / block] = 1;
        number(k)[i] = values[r];
      }
  }
}

template class PlasticBlocks<2>;
template class PlasticBlocks<3>;
} // namespace ligament::dem
