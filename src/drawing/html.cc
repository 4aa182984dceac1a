#include "src/drawing/html.h"

#include "src/output/format.h"

namespace ligament::program
{
namespace
{
constexpr const char *style = R"(
body{font:15px/1.5 system-ui,sans-serif;color:#222;max-width:1080px;margin:2em auto;padding:0 1em}
h1{font-size:1.7em;margin:0 0 .2em}
h2{font-size:1.2em;margin:2em 0 .5em;border-bottom:1px solid #d5dae0}
.headline{font-size:1.15em;margin:.3em 0}
.verdict{background:#eef4f8;border-left:4px solid #1b6ca8;padding:.6em .9em;margin:1em 0}
.bad{background:#fbeeee;border-left-color:#d1495b}
.pictures{display:flex;flex-wrap:wrap;gap:1em}
figure{margin:0;flex:1 1 440px}
figure img,svg{max-width:100%;height:auto}
figure img{max-height:820px;width:auto}
figcaption{color:#555;font-size:.9em}
table{border-collapse:collapse;margin:.5em 0}
th,td{padding:.2em .8em;border-bottom:1px solid #e3e6ea;text-align:right;white-space:nowrap}
th:first-child,td:first-child{text-align:left}
pre{background:#f5f6f8;padding:.8em;overflow:auto;font-size:.85em}
@media print{body{margin:0;max-width:none}h2,figure,table{break-inside:avoid}}
)";
} // namespace

std::string html_page(const std::string &title, const std::string &body)
{
  return "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"/>\n"
         "<meta name=\"viewport\" content=\"width=device-width\"/>\n<title>" +
         escape_xml(title) + "</title>\n<style>" + style + "</style></head><body>\n" + "<h1>" +
         escape_xml(title) + "</h1>\n" + body + "</body></html>\n";
}

std::string html_table(const std::vector<std::string> &head,
                       const std::vector<std::vector<std::string>> &rows)
{
  std::string text = "<table>\n<tr>";
  for (const auto &cell : head)
    text += "<th>" + escape_xml(cell) + "</th>";
  text += "</tr>\n";
  for (const auto &row : rows) {
    text += "<tr>";
    for (const auto &cell : row)
      text += "<td>" + escape_xml(cell) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
}
} // namespace ligament::program
