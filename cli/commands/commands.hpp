#pragma once

#include "moving/ranks.hpp"
#include "options/options.hpp"

namespace supple::cli {

// Each runs a command and returns the exit status. Throws `Error` for unusable input.
int run_detect(const DetectOptions& options, Ranks& ranks);
int run_simulate(const SimulateOptions& options, Ranks& ranks);
int run_view(const ViewOptions& options);
int run_render(const RenderOptions& options);
int run_info(const InfoOptions& options);
int run_query(const QueryOptions& options);
int run_ccd_queries(const CcdQueriesOptions& options);
int run_diff(const DiffOptions& options);

}  // namespace supple::cli
