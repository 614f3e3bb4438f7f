#include "reports/reports.hpp"

#include <fmt/core.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <utility>

#include "base/run_program.hpp"
#include "base/text.hpp"
#include "inputs/inputs.hpp"
#include "moving/moving_objects.hpp"
#include "supple/result_descriptions.hpp"

namespace supple::cli {
namespace {

std::string describe(const Input& input, const Difference& d) {
  return fmt::format("triangle {} of {} and triangle {} of {} {}", d.triangle_a,
                     one_line(input.name(d.object_a)), d.triangle_b, one_line(input.name(d.object_b)),
                     d.missed ? "intersect and were not reported" : "were reported and do not intersect");
}

/// What is different, by fault.
constexpr std::array outcomes_of_impacts{"touch and were not reported", "were reported and do not touch",
                                         "were reported with a time after they touch",
                                         "were reported with a time too long before they touch"};
constexpr std::array outcomes_of_pairs{"are near and were not reported", "were reported and are not near",
                                       "were reported with wrong features or an inaccurate distance"};
constexpr std::array outcomes_of_vertices{
    "is inside or on the surface of it and was not reported so",
    "was reported as inside or on the surface of it and is not",
    "was reported with a triangle that is not the nearest or with an inaccurate depth"};

/// Describes a difference that names two elements.
std::string describe(const Input& input, const auto& d) {
  const auto named = [&](FeatureKind kind, const std::array<std::uint32_t, 2>& ids, ObjectId object) {
    return fmt::format("{} of {}", element_name(kind, ids), one_line(input.name(object)));
  };
  const auto described = [&](FeatureKind a, FeatureKind b, const auto& outcomes) {
    return fmt::format("{} and {} {}", named(a, d.element_a, d.object_a), named(b, d.element_b, d.object_b),
                       outcomes[static_cast<std::size_t>(d.fault)]);
  };
  if constexpr (requires { d.kind_a; })
    return described(d.kind_a, d.kind_b, outcomes_of_pairs);
  else
    return described(feature_kinds(d.kind)[0], feature_kinds(d.kind)[1], outcomes_of_impacts);
}

std::string describe(const Input& input, const PenetrationDifference& d) {
  return fmt::format("for {}: vertex {} of {} {}", one_line(input.name(d.object_b)), d.vertex,
                     one_line(input.name(d.object_a)),
                     outcomes_of_vertices[static_cast<std::size_t>(d.fault)]);
}

void print_difference(const Input& input, std::uint64_t frame, const VerifyReport& report) {
  const std::string first =
      !report.continuous_differences.empty()  ? describe(input, report.continuous_differences.front())
      : !report.differences.empty()           ? describe(input, report.differences.front())
      : !report.proximity_differences.empty() ? describe(input, report.proximity_differences.front())
                                              : describe(input, report.penetration_differences.front());
  fmt::print(stderr, "supple: verify: frame {} has {} from brute force; the first: {}\n", frame,
             counted(report.difference_count(), "difference"), first);
}

}  // namespace

Reports::Reports(const DetectionOptions& options, const Input& input, const MovingObjects& objects,
                 std::string noun)
    : options_(options),
      input_(input),
      objects_(objects),
      solid_parts_(describe_solid_parts(input)),
      tested_(input, input.simulation.scene.contacts) {
  if (options.json_content.node_pairs) check_node_pairs(input, *options.json_content.node_pairs);
  if (!options.json.empty())
    files_.push_back(make_json_report(options.json, input, objects, options.json_content));
  if (!options.csv.empty())
    files_.push_back(make_csv_report(options.csv, options.scene, options.json_content.contact_details));
  if (!options.quiet && options.json != "-" && options.csv != "-")
    text_ = make_text_report(std::move(noun), input, objects, tested_);
}

void Reports::add(const Frame& frame) {
  for (const auto& file : files_) file->add(frame);
  if (text_) text_->add(frame);
  tested_.add(frame);
  last_frame_ = frame.number;
  if (frame.result.truncated) ++truncated_frames_;
  for (const ContactKindInfo& kind : contact_kinds) touched_ = touched_ || kind.is_in(frame.result);
  if (frame.verify && !frame.verify->agrees() && !std::exchange(differed_, true))
    print_difference(input_, frame.number, *frame.verify);
}

void Reports::finish(bool was_ended) {
  was_ended_ = was_ended;
  for (const auto& file : files_) file->finish(was_ended);
  if (truncated_frames_ > 0)
    fmt::print(stderr, "supple: {} more contacts than --max-contacts {}; the results are truncated\n",
               truncated_frames_ == 1 ? "a frame has" : counted(truncated_frames_, "frame") + " have",
               options_.limits.max_contacts);
  if (!text_) {
    if (!options_.quiet && !is_failing()) report_faults("warning");
    return;
  }
  text_->finish(was_ended);
  if (!solid_parts_.empty()) fmt::print("\n{}\n", solid_parts_);
  if (const auto& objects = options_.json_content.node_pairs; objects && !was_ended)
    print_node_pairs(objects_.scene(), *objects, last_frame_);
}

void Reports::report_faults(const char* what) const {
  if (const std::vector<std::string> faults = tested_.faults(); !faults.empty())
    fmt::print(stderr, "supple: {}: {}\n", what, fmt::join(faults, "; "));
}

int Reports::exit_status() const {
  if (differed_) return exit_differences;
  if (!is_failing()) return options_.fail_on_contact && touched_ ? exit_contact : exit_done;
  report_faults("--fail-on-contact");
  return was_ended_ || !tested_.faults().empty() ? exit_unusable : exit_done;
}

}  // namespace supple::cli
