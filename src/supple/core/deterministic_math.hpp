#pragma once

// The functions are public, so that programs can repeat their motion bit by bit as well.
#include "supple/trigonometry.hpp"
