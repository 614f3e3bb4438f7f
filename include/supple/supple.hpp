#pragma once

/// All headers of the core, without the components models, simulation, formats and recording.
#include "supple/broad_phase.hpp"
#include "supple/comparison_options.hpp"
#include "supple/contact.hpp"
#include "supple/continuous.hpp"
#include "supple/error.hpp"
#include "supple/inspection.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/result.hpp"
#include "supple/scene.hpp"
#include "supple/topology.hpp"
#include "supple/triangle_intersection.hpp"
#include "supple/trigonometry.hpp"
#include "supple/types.hpp"
#include "supple/version.hpp"
#include "supple/views.hpp"
