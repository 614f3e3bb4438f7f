#pragma once

/// Semantic version of the library; CMake reads it from here, so this is its only place.
#define SUPPLE_VERSION_MAJOR 0
#define SUPPLE_VERSION_MINOR 1
#define SUPPLE_VERSION_PATCH 0
#define SUPPLE_VERSION "0.1.0"
