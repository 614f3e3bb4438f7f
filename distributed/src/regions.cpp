#include "regions.hpp"

#include <zoltan.h>

#include "core/error.hpp"

namespace supple {

/// What Zoltan asks for.
struct Callbacks {
  static std::span<const WeightedPoint> points(void* regions) {
    return static_cast<const Regions*>(regions)->points_;
  }
  static int count(void* regions, int* error) {
    *error = ZOLTAN_OK;
    return static_cast<int>(points(regions).size());
  }
  static void list(void* regions, int, int, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR, int, float* weights,
                   int* error) {
    *error = ZOLTAN_OK;
    for (std::size_t i = 0; i < points(regions).size(); ++i) {
      global[i] = static_cast<ZOLTAN_ID_TYPE>(i);  // of this rank: no two ranks compare them
      weights[i] = static_cast<float>(points(regions)[i].weight);
    }
  }
  static int dimensions(void*, int* error) {
    *error = ZOLTAN_OK;
    return 3;
  }
  static void positions(void* regions, int, int, int count, ZOLTAN_ID_PTR global, ZOLTAN_ID_PTR, int,
                        double* coordinates, int* error) {
    *error = ZOLTAN_OK;
    for (int i = 0; i < count; ++i) {
      const Vec3d& p = points(regions)[global[i]].position;
      for (int axis = 0; axis < 3; ++axis) coordinates[3 * i + axis] = p[axis];
    }
  }
};

Regions::Regions(const Communicator& communicator) : rank_(communicator.rank()) {
  float version = 0;
  if (Zoltan_Initialize(0, nullptr, &version) != ZOLTAN_OK) fail("Zoltan does not start");
  zoltan_ = Zoltan_Create(communicator.handle());
  // The level of messages comes first: the others print.
  const char* const parameters[][2] = {
      {"DEBUG_LEVEL", "0"},     {"LB_METHOD", "RCB"},     {"KEEP_CUTS", "1"},      {"RETURN_LISTS", "NONE"},
      {"NUM_GID_ENTRIES", "1"}, {"NUM_LID_ENTRIES", "0"}, {"OBJ_WEIGHT_DIM", "1"}, {"IMBALANCE_TOL", "1.02"}};
  for (const auto& [name, value] : parameters) Zoltan_Set_Param(zoltan_, name, value);
  Zoltan_Set_Num_Obj_Fn(zoltan_, Callbacks::count, this);
  Zoltan_Set_Obj_List_Fn(zoltan_, Callbacks::list, this);
  Zoltan_Set_Num_Geom_Fn(zoltan_, Callbacks::dimensions, this);
  Zoltan_Set_Geom_Multi_Fn(zoltan_, Callbacks::positions, this);
  ranks_.resize(static_cast<std::size_t>(communicator.size()));
}

Regions::~Regions() {
  int is_finalized = 0;
  MPI_Finalized(&is_finalized);
  if (is_finalized == 0) Zoltan_Destroy(&zoltan_);
}

void Regions::divide(std::span<const WeightedPoint> points) {
  points_ = points;
  int changes = 0, id_size = 0, local_id_size = 0, imports = 0, exports = 0;
  ZOLTAN_ID_PTR import_ids = nullptr, import_local = nullptr, export_ids = nullptr, export_local = nullptr;
  int *import_ranks = nullptr, *import_parts = nullptr, *export_ranks = nullptr, *export_parts = nullptr;
  const int status = Zoltan_LB_Partition(zoltan_, &changes, &id_size, &local_id_size, &imports, &import_ids,
                                         &import_local, &import_ranks, &import_parts, &exports, &export_ids,
                                         &export_local, &export_ranks, &export_parts);
  points_ = {};
  Zoltan_LB_Free_Part(&import_ids, &import_local, &import_ranks, &import_parts);
  Zoltan_LB_Free_Part(&export_ids, &export_local, &export_ranks, &export_parts);
  if (status != ZOLTAN_OK && status != ZOLTAN_WARN) fail("Zoltan cannot divide space; it ran out of memory");
  are_divided_ = true;
  if (ranks_.size() == 1) return;  // Zoltan has no cuts
  int axes = 0;
  if (Zoltan_RCB_Box(zoltan_, rank_, &axes, &own_.min.x, &own_.min.y, &own_.min.z, &own_.max.x, &own_.max.y,
                     &own_.max.z) != ZOLTAN_OK)
    fail("Zoltan does not tell the region of a rank");
}

std::span<const int> Regions::ranks_of(const Aabb& box) {
  int count = 0;
  const int status = Zoltan_LB_Box_Assign(zoltan_, box.min.x, box.min.y, box.min.z, box.max.x, box.max.y,
                                          box.max.z, ranks_.data(), &count);
  if (status != ZOLTAN_OK && status != ZOLTAN_WARN) fail("Zoltan finds no ranks for a box");
  return std::span<const int>(ranks_).first(static_cast<std::size_t>(count));
}

}  // namespace supple
