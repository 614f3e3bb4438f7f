#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>

#include "supple/description.hpp"
#include "supple/viewer.hpp"

namespace supple {

template <>
inline constexpr std::array words<viewer::FieldElement>{"vertex", "face"};

namespace viewer {

/// Of `supple view` and of an attached program.
inline constexpr const char* spectators_doc =
    "Make a second address: whoever opens it sees what the page shows of the scene, with a camera of their "
    "own, and controls nothing";

}  // namespace viewer

/// Without the names of objects, which belong to `contact_begin`.
template <>
struct Description<viewer::BreakOptions> {
  static constexpr const char* name = "BreakOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = viewer::BreakOptions;
    visitor(Field<Options, bool>{
        .name = "contact_begin", .member = &Options::contact_begin, .doc = "Two objects begin to touch"});
    visitor(Field<Options, bool>{
        .name = "intersection", .member = &Options::intersection, .doc = "Triangles intersect"});
    visitor(Field<Options, std::optional<std::uint64_t>>{.name = "contacts_above",
                                                         .member = &Options::contacts_above,
                                                         .doc = "More contacts than",
                                                         .range = ValueRange::from(0)});
    visitor(Field<Options, std::optional<double>>{.name = "depth_above",
                                                  .member = &Options::depth_above,
                                                  .doc = "A vertex deeper in a solid than",
                                                  .range = ValueRange::from(0),
                                                  .unit = "length"});
    visitor(Field<Options, bool>{
        .name = "not_finite", .member = &Options::not_finite, .doc = "A vertex is NaN or infinite"});
  }
};

template <>
struct Description<viewer::AttachOptions> {
  static constexpr const char* name = "AttachOptions";
  static constexpr void visit(auto&& visitor) {
    using Options = viewer::AttachOptions;
    visitor(
        Field<Options, std::string>{.name = "title", .member = &Options::title, .doc = "Title of the page"});
    visitor(Field<Options, std::string>{
        .name = "address", .member = &Options::address, .doc = "An IP address of this machine"});
    visitor(Field<Options, std::uint16_t>{.name = "port",
                                          .member = &Options::port,
                                          .doc = "Port of the page; 0 is any free one",
                                          .range = ValueRange::from(0, 65535)});
    visitor(Field<Options, std::string>{
        .name = "token_file",
        .member = &Options::token_file,
        .doc = "A file that keeps the token of the address; made when it does not exist"});
    visitor(Field<Options, bool>{.name = "open_browser",
                                 .member = &Options::open_browser,
                                 .doc = "Open the page in the browser, if there is a screen"});
    visitor(Field<Options, double>{.name = "max_slowdown",
                                   .member = &Options::max_slowdown,
                                   .doc = "The share of the program's time that frames may take",
                                   .range = ValueRange::from(0)});
    visitor(Field<Options, double>{.name = "time_step",
                                   .member = &Options::time_step,
                                   .doc = "Time between two steps; 0 shows no time",
                                   .range = ValueRange::from(0),
                                   .unit = "s"});
    visitor(Field<Options, bool>{.name = "wait_for_page",
                                 .member = &Options::wait_for_page,
                                 .doc = "The first step and each break wait until a page is connected"});
    visitor(Field<Options, double>{.name = "history_bytes",
                                   .member = &Options::history_bytes,
                                   .doc = "Memory for the last steps, to which the page can go back",
                                   .range = ValueRange::from(0),
                                   .unit = "bytes"});
    visitor(Field<Options, bool>{
        .name = "spectators", .member = &Options::spectators, .doc = viewer::spectators_doc});
    visitor(Field<Options, viewer::BreakOptions>{
        .name = "breaks", .member = &Options::breaks, .doc = "Events that pause the program"});
  }
};

}  // namespace supple
