#include "src/output/stroke_font.h"

#include <algorithm>
#include <cstring>

namespace ligament::program
{
namespace
{
struct Glyph
{
  char character;
  const char *strokes;
};

/// Pairs of coordinates x, y on a grid with capitals 6 high and small letters 4; strokes are parted
/// by blanks; a and b stand for y = -1 and -2. 'u' with a tail (µ) is stored as 0x01.
constexpr Glyph glyphs[] = {{'A', "002640 1232"},
                            {'B', "00063645443303 3342413000"},
                            {'C', "4536160501103041"},
                            {'D', "00062644422000"},
                            {'E', "46060040 0333"},
                            {'F', "460600 0333"},
                            {'G', "45361605011030414323"},
                            {'H', "0006 4046 0343"},
                            {'I', "2026"},
                            {'J', "4641301001"},
                            {'K', "0006 4602 1340"},
                            {'L', "060040"},
                            {'M', "0006234640"},
                            {'N', "00064046"},
                            {'O', "103041453616050110"},
                            {'P', "00063645443303"},
                            {'Q', "103041453616050110 2240"},
                            {'R', "00063645443303 2340"},
                            {'S', "453616050413334241301001"},
                            {'T', "0646 2026"},
                            {'U', "060110304146"},
                            {'V', "062046"},
                            {'W', "0610243046"},
                            {'X', "0046 0640"},
                            {'Y', "062346 2320"},
                            {'Z', "06460040"},
                            {'a', "4044 4334140301103041"},
                            {'b', "0006 0314344341301001"},
                            {'c', "4334140301103041"},
                            {'d', "4046 4334140301103041"},
                            {'e', "02424334140301103041"},
                            {'f', "36261510 0424"},
                            {'g', "444a3b1b0a 4334140301103041"},
                            {'h', "0006 0314344340"},
                            {'i', "2024 2626"},
                            {'j', "242a1b0b 2626"},
                            {'k', "0006 4401 1240"},
                            {'l', "2026"},
                            {'m', "0004 03142320 23344340"},
                            {'n', "0004 0314344340"},
                            {'o', "103041433414030110"},
                            {'p', "0b04 0314344341301001"},
                            {'q', "4b44 4334140301103041"},
                            {'r', "0004 021434"},
                            {'s', "43341403123241301001"},
                            {'t', "16112030 0424"},
                            {'u', "0401103041 4440"},
                            {'v', "042044"},
                            {'w', "0410233044"},
                            {'x', "0044 0440"},
                            {'y', "0420 441b"},
                            {'z', "04440040"},
                            {'0', "103041453616050110"},
                            {'1', "152620 1030"},
                            {'2', "05163645440040"},
                            {'3', "05163645443323 334241301001"},
                            {'4', "30360242"},
                            {'5', "460603334241301001"},
                            {'6', "4536160501103041423303"},
                            {'7', "064610"},
                            {'8', "133344453616050413 1302011030414233"},
                            {'9', "011030414536160504133343"},
                            {'.', "2020"},
                            {',', "211b"},
                            {':', "2121 2424"},
                            {';', "211b 2424"},
                            {'-', "0333"},
                            {'+', "0343 2125"},
                            {'=', "0242 0444"},
                            {'/', "0046"},
                            {'(', "36242230"},
                            {')', "16242210"},
                            {'[', "36161b3b"},
                            {']', "16363b1b"},
                            {'%', "0046 0506161505 3031414030"},
                            {'^', "142634"},
                            {'_', "0b4b"},
                            {'*', "2125 0442 0244"},
                            {'\'', "2624"},
                            {'"', "1614 3634"},
                            {'<', "450341"},
                            {'>', "054301"},
                            {'|', "2b26"},
                            {'!', "2622 2020"},
                            {'?', "0516364544332322 2020"},
                            {'#', "1016 3036 0444 0242"},
                            {'&', "4006051625040110203042"},
                            {'\x01', "0b04 01103041 4440"}};

constexpr double grid = 1. / 6; // one grid step in heights of a capital
constexpr double gap = 2 * grid, blank = 3 * grid;

double coordinate(char c)
{
  return grid * (c >= 'a' ? 'a' - 1 - c : c - '0');
}

/// Appends the strokes of a glyph at x and returns its width.
double append(std::vector<Polyline> &strokes, const Glyph &glyph, double x)
{
  const std::size_t first = strokes.size();
  strokes.emplace_back();
  for (const char *c = glyph.strokes; *c; ++c)
    if (*c == ' ')
      strokes.emplace_back();
    else {
      strokes.back().push_back({coordinate(c[0]), coordinate(c[1])});
      ++c;
    }
  double left = 1, right = 0;
  const auto each_point = [&](auto &&visit) {
    for (std::size_t s = first; s < strokes.size(); ++s)
      for (auto &point : strokes[s])
        visit(point[0]);
  };
  each_point([&](double &px) {
    left = std::min(left, px);
    right = std::max(right, px);
  });
  each_point([&](double &px) { px += x - left; });
  return right - left;
}
} // namespace

StrokedText stroke_text(const std::string &text)
{
  StrokedText result{{}, 0};
  for (std::size_t i = 0; i < text.size(); ++i) {
    char c = text[i];
    if (std::strncmp(&text[i], "\xc2\xb5", 2) == 0) {
      c = '\x01';
      ++i;
    }
    const auto *glyph = std::find_if(std::begin(glyphs), std::end(glyphs),
                                     [&](const Glyph &g) { return g.character == c; });
    if (glyph == std::end(glyphs))
      result.width += blank;
    else
      result.width += append(result.strokes, *glyph, result.width) + gap;
  }
  return result;
}
} // namespace ligament::program
