#include "contest/output.hpp"

#include <algorithm>
#include <cstdio>
#include <string_view>

#include "supple/version.hpp"

namespace supple::benchmarks {
namespace {

std::string json_string(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + '"';
}

std::string list_of(const std::vector<double>& values) {
  std::string text;
  char number[32];
  for (const double value : values) {
    std::snprintf(number, sizeof number, "%s%.6g", text.empty() ? "" : ", ", value);
    text += number;
  }
  return '[' + text + ']';
}

}  // namespace

void add_stages(Record& record, const std::vector<StageTime>& stages) {
  if (record.stage_sums.empty())
    record.stage_sums = stages;
  else
    for (std::size_t i = 0; i < stages.size(); ++i)
      record.stage_sums[i].cpu_milliseconds += stages[i].cpu_milliseconds;
}

void Output::value(const std::string& name, double number) {
  char text[64];
  std::snprintf(text, sizeof text, "%.8g", number);
  values_ += (values_.empty() ? "" : ", ") + json_string(name) + ": " + text;
}

void Output::records(const std::vector<Record>& records) {
  for (const Record& record : records) {
    std::string stages;
    const auto frames = static_cast<double>(std::max<std::size_t>(record.cpu.size(), 1));
    for (const StageTime& stage : record.stage_sums) {
      char number[32];
      std::snprintf(number, sizeof number, "%.6g", stage.cpu_milliseconds / frames);
      stages += (stages.empty() ? "" : ", ") + json_string(stage.name) + ": " + number;
    }
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(record.first_pairs.hash));
    contestants_ += (contestants_.empty() ? "\n  " : ",\n  ") + std::string("{\"name\": ") +
                    json_string(record.name) + ", \"threads\": " + std::to_string(record.threads) +
                    ", \"pairs\": " + std::to_string(record.first_pairs.count) + ", \"hash\": \"" + hash +
                    "\", \"cpu_ms\": " + list_of(record.cpu) + ", \"wall_ms\": " + list_of(record.wall) +
                    ", \"mean_stage_ms\": {" + stages + "}}";
  }
}

void Output::print() const {
  std::printf(
      "{\"cell\": %s, \"version\": \"%s\", \"skipped\": %s,\n \"values\": {%s},\n \"contestants\": [%s]}\n",
      json_string(cell_).c_str(), SUPPLE_VERSION, skipped_.empty() ? "null" : json_string(skipped_).c_str(),
      values_.c_str(), contestants_.c_str());
}

}  // namespace supple::benchmarks
