#pragma once

#include <string>

#include "output_file.hpp"
#include "report.hpp"
#include "supple/options.hpp"

namespace supple::cli {

/// Writes one row per contact, as docs/json.md describes: the frame, the objects, and their triangles or
/// elements.
class CsvReport {
 public:
  CsvReport(const std::string& file_name, ContactKinds contacts);

  void add(const Frame& frame);
  void finish() { file_.close(); }

 private:
  OutputFile file_;
};

}  // namespace supple::cli
