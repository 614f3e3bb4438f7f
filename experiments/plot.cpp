#include "plot.hpp"

#include <fmt/core.h>
#include <sys/wait.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string_view>

namespace supple::experiments {
namespace {

namespace fs = std::filesystem;

/// Distinguishable on white and on black, also for most people with colour blindness.
constexpr std::array<const char*, 9> palette{"#0077bb", "#ee7733", "#009988", "#cc3311", "#9467bd",
                                             "#888888", "#33bbee", "#ee3377", "#999933"};
/// gnuplot's numbers of filled shapes: circle, square, triangles and others.
constexpr std::array<int, 5> point_types{7, 5, 9, 11, 13};
/// Names along x that fit without rotation.
constexpr std::size_t most_level_names = 5;

/// A gnuplot string in single quotes, in which only the quote is special.
std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? std::string("''") : std::string(1, c);
  return result + '\'';
}

std::string style_of(const Series& series, std::size_t color) {
  const char* const shade = palette[color % palette.size()];
  switch (series.style) {
    case Series::Style::points:
      return fmt::format("with points pt {} ps 0.9 lc rgb '{}'", point_types[color % point_types.size()],
                         shade);
    case Series::Style::dashed_line:
      return fmt::format("with lines dt 2 lw 1.5 lc rgb '{}'", shade);
    case Series::Style::line_and_points:
      break;
  }
  return fmt::format("with linespoints pt 7 ps 0.6 lw 2 lc rgb '{}'", shade);
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

/// Removes every ` name="…"` or ` name='…'`.
void remove_attribute(std::string& text, const std::string& name) {
  for (std::size_t at = 0; (at = text.find(name + "=", at)) != std::string::npos;) {
    const std::size_t quote = at + name.size() + 1;
    text.erase(at, text.find(text[quote], quote + 1) + 1 - at);
  }
}

/// Turns an SVG document into an element of a page.
std::string inlined(std::string svg, int number) {
  svg.erase(0, svg.find("<svg"));
  replace_all(svg, "xlink:href", "href");
  remove_attribute(svg, "xmlns:xlink");
  remove_attribute(svg, "xmlns");
  // Several plots on one page must not share ids.
  const std::string prefix = fmt::format("plot{}_", number);
  for (const char quote : {'"', '\''}) {
    replace_all(svg, fmt::format(" id={}", quote), fmt::format(" id={}{}", quote, prefix));
    replace_all(svg, fmt::format("href={}#", quote), fmt::format("href={}#{}", quote, prefix));
  }
  replace_all(svg, "url(#", "url(#" + prefix);
  // Black becomes the text colour of the page, so that dark pages work too.
  for (const char* const name : {"fill", "stroke", "color"}) {
    for (const char quote : {'"', '\''})
      for (const char* const black : {"black", "rgb(0,0,0)", "rgb(  0,   0,   0)", "#000000"})
        replace_all(svg, fmt::format("{}={}{}{}", name, quote, black, quote),
                    fmt::format("{}=\"currentColor\"", name));
  }
  return svg;
}

std::string contents_of(const fs::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  return text.str();
}

/// A temporary folder for one drawing.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (fs::temp_directory_path() / "supple-plot-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw Error(
          fmt::format("{}: cannot make a folder for plots; set TMPDIR to one that is yours", pattern));
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// Writes large numbers as 10 k, 100 k. A logarithmic axis is only as long as the points need.
std::string ranges_of(const Plot& plot) {
  double low = 0, high = 0, highest_y = 0;
  for (const Series& series : plot.series) {
    for (const auto& [x, y] : series.points) {
      low = high == 0 ? x : std::min(low, x);
      high = std::max(high, x);
      highest_y = std::max(highest_y, y);
    }
  }
  std::string script = highest_y >= 1e5 ? "set format y '%.0s %c'\n" : "set format y '%g'\n";
  if (plot.logarithmic_x && low > 0) script += fmt::format("set xrange [{}:{}]\n", low / 1.25, high * 1.25);
  return script;
}

}  // namespace

GnuplotMissing::GnuplotMissing()
    : Error(
          "plots need the program gnuplot, which is not there; install it, on Debian by: apt-get install "
          "gnuplot-nox") {}

std::string gnuplot_script(const Plot& plot) {
  std::string script =
      "set terminal svg noenhanced size 760,430 dynamic font 'sans-serif,14'\n"
      "set border 3\nset tics nomirror\nset grid lc rgb '#999999' lw 0.4 dt 1\n"
      "set key outside right top Left reverse samplen 2 spacing 1.15\n";
  script += fmt::format("set title {}\nset xlabel {}\nset ylabel {}\n", quoted(plot.title),
                        quoted(plot.x_label), quoted(plot.y_label));
  if (plot.logarithmic_x) script += "set logscale x\nset format x '%.0s %c'\n";
  if (plot.logarithmic_y) script += "set logscale y\n";
  script += ranges_of(plot);
  if (!plot.logarithmic_y) script += "set yrange [0:*]\n";
  if (!plot.x_names.empty()) {
    std::string names;
    for (const auto& [x, name] : plot.x_names)
      names += fmt::format("{}{} {}", names.empty() ? "" : ", ", quoted(name), x);
    script += fmt::format("set xtics {}({})\nset xrange [{}:{}]\n",
                          plot.x_names.size() > most_level_names ? "rotate by -20 " : "", names,
                          plot.x_names.front().first - 0.8, plot.x_names.back().first + 0.8);
  }
  std::string lines, data;
  std::size_t next_color = 0;
  for (const Series& series : plot.series) {
    if (series.points.empty()) continue;
    const std::size_t color = series.color >= 0 ? static_cast<std::size_t>(series.color) : next_color++;
    lines += fmt::format("{}'-' {} {}", lines.empty() ? "plot " : ", ", style_of(series, color),
                         series.label.empty() ? "notitle" : "title " + quoted(series.label));
    for (const auto& [x, y] : series.points) data += fmt::format("{} {}\n", x, y);
    data += "e\n";
  }
  return lines.empty() ? script : script + lines + '\n' + data;
}

std::string svg_of(const Plot& plot, int number) {
  const ScratchFolder scratch;
  const fs::path script = scratch.path() / "script", image = scratch.path() / "plot.svg";
  {
    std::ofstream stream(script, std::ios::binary);
    stream << "set output " << quoted(image.string()) << '\n' << gnuplot_script(plot);
  }
  const std::string command =
      fmt::format("gnuplot '{}' 2>'{}'", script.string(), (scratch.path() / "errors").string());
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 127) throw GnuplotMissing();
  const std::string svg = contents_of(image);
  if (status != 0 || svg.find("</svg>") == std::string::npos)
    throw Error(fmt::format("gnuplot cannot draw the plot '{}': {}; does `gnuplot --version` say 5 or later?",
                            plot.title, contents_of(scratch.path() / "errors")));
  return inlined(svg, number);
}

}  // namespace supple::experiments
