#pragma once

#include <string>

#include "output_file.hpp"
#include "report.hpp"

namespace supple::cli {

/// A row a triangle pair, `frame,a,b,i,j`: objects a and b, equal for a contact of an object with itself, and
/// their triangles.
class CsvReport {
 public:
  explicit CsvReport(const std::string& file_name);

  void add(const Frame& frame);
  void finish() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace supple::cli
