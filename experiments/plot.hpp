#pragma once

#include <string>
#include <utility>
#include <vector>

#include "fit.hpp"
#include "supple/error.hpp"

namespace supple::experiments {

struct Series {
  enum class Style { line_and_points, points, dashed_line };
  std::string label;
  Points points;
  Style style = Style::line_and_points;
  int color = -1;  ///< index in the palette; -1: the next color
};

struct Plot {
  std::string title;
  std::string x_label, y_label;
  bool logarithmic_x = true, logarithmic_y = true;
  std::vector<Series> series{};
  /// Labels instead of numbers along x.
  std::vector<std::pair<double, std::string>> x_names{};
};

/// gnuplot is not installed.
struct GnuplotMissing : Error {
  GnuplotMissing();
};

/// The gnuplot input that draws the plot as SVG.
std::string gnuplot_script(const Plot& plot);
/// Draws a plot with the program `gnuplot`. Returns an <svg> element for HTML, which uses no external
/// resources and the text colour of the page. `number` distinguishes the plots of one page. Throws
/// `GnuplotMissing`, or `Error` when gnuplot fails.
std::string svg_of(const Plot& plot, int number);

}  // namespace supple::experiments
