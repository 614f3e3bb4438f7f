#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "inputs/frame_files.hpp"
#include "inputs/reading.hpp"
#include "supple/mesh.hpp"
#include "supple/options.hpp"
#include "supple/recording.hpp"
#include "supple/simulation.hpp"
#include "supple/wave_motion.hpp"

namespace supple::cli {

/// The positions of an object in each frame of a recording.
struct RecordedMotion {
  std::shared_ptr<const Recording> recording;
  std::size_t object = 0;  ///< its index in the recording
};

/// The positions of an object in each frame, computed on demand. After the last frame it stays or starts
/// again, as `positions` decides.
struct ComputedMotion {
  std::uint64_t count = 0;  ///< of frames
  std::function<void(std::uint64_t frame, std::span<Vec3d> positions)> positions;
};

/// The motion of an object from frame to frame.
using Motion =
    std::variant<WaveMotion, MassSpringMotion, RigidMotion, FrameSequence, ComputedMotion, RecordedMotion>;

/// Where an object comes from that is a part of a mesh.
struct PartOfMesh {
  std::string mesh;                                ///< the name of the whole mesh
  std::vector<std::uint32_t> vertices, triangles;  ///< ids in the whole mesh
  /// Why a part of a solid mesh is not solid; empty when it is.
  std::optional<std::string> not_solid{};
};

/// A placed object to add to the scene.
struct InputObject {
  TriangleMesh mesh;
  ObjectOptions options;
  std::optional<Motion> motion;
  bool splits = false;  ///< each connected part shall be an object
  std::optional<PartOfMesh> part{};
};

/// The motion of an object when it is of this kind, else null.
template <class Kind>
const Kind* motion_of(const InputObject& object) {
  return object.motion ? std::get_if<Kind>(&*object.motion) : nullptr;
}

/// The input of a command: objects and their motion.
struct Input {
  std::vector<InputObject> objects;
  SimulationOptions simulation;
  /// The frames of a sequence or a recording.
  struct Frames {
    std::string name{};  ///< name in messages
    std::uint64_t count = 0;
  };
  std::optional<Frames> frames{};
  std::string scene_text;                    ///< of the scene file; empty when there is none
  std::vector<std::filesystem::path> files;  ///< all that were read or will be read
  std::vector<std::string> notes{};          ///< what users should know about the files, for standard error

  /// The name of an object in results.
  std::string name(ObjectId object) const;
};

bool is_scene_file(const std::string& name);
/// True for the extensions .h5 and .hdf5.
bool is_recording(const std::string& name);

/// Reads meshes, one object each, by name or quoted pattern (`part*.obj`, sorted by the numbers in the
/// names); or one scene file; or one recording.
Input read_objects(const std::vector<std::string>& names, const SceneOverrides& overrides = {},
                   const MeshReading& reading = {});
/// Reads a sequence: the object of the first frame, moved by all frames.
Input read_sequence(const std::vector<std::string>& names, const CoordinateConversion& conversion = {});
/// Reads the objects of a recording with their options, in its order, with the positions of the first frame.
/// Throws `Error` when it cannot be read or has no frame.
Input read_recording(const std::string& name);
/// The frames of an object that mesh files, an animation or a recording move; nothing for others.
std::optional<ComputedMotion> frames_of(const InputObject& object);
/// Replaces each object with `InputObject::splits` by its connected parts, in their order. A part is solid
/// when the object is and the part bounds a solid. Adds a note where parts of a solid that is not split
/// intersect. Throws `Error` for objects of a recording.
void split_parts(Input& input);

/// A sentence that names the parts that are solid, and why the others are not; empty without parts of solid
/// objects.
std::string describe_solid_parts(const Input& input);

/// `walk.glb: has 2 clips: walk, run; ` and the advice.
std::string clips_note(const std::filesystem::path& path, const std::vector<std::string>& clips,
                       const char* advice);
/// What the reader of the file may get wrong; empty for most.
std::string note_of_reader(const std::filesystem::path& path);
/// The number and name of an object, for tables.
std::string name_of(const Input& input, ObjectId object);
/// Prints the notes of an input to standard error.
void print_notes(const Input& input);

/// The triangles whose vertices are all finite: others touch nothing.
std::size_t count_finite_triangles(const TriangleMesh& mesh);

/// Replaces each pattern by the matching files, sorted by the numbers in the names: frame_9 before frame_10.
/// Throws `Error` when no file matches.
std::vector<std::filesystem::path> expand_patterns(const std::vector<std::string>& names);
/// One line about the gaps in the numbers of a sequence: steps that are larger than the smallest one. Empty
/// when there is none, and when the names do not differ in their last number alone, in ascending order.
std::string describe_gaps(const std::vector<std::filesystem::path>& files);
bool natural_less(const std::string& a, const std::string& b);

}  // namespace supple::cli
