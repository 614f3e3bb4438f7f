#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>

#include "supple/error.hpp"
#include "support/soups.hpp"
#include "unit/recording/recorded_scenes.hpp"

namespace supple::damaged_recording_test {

/// Modifies a valid recording through HDF5. The tests expect a message that states the damage.
class DamagedRecording : public testing::Test {
 protected:
  DamagedRecording() {
    SceneOptions scene;
    scene.threads = 1;
    simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5)}, {}, scene, 4)
        .write(folder_ / "run.h5");
    scene.contacts = ContactKinds::continuous;
    ObjectOptions with_lines;
    with_lines.edges = {{0, 40}, {40, 41}};
    with_lines.points = {7};
    simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5)}, {with_lines}, scene, 4)
        .write(folder_ / "moving.h5");
    scene.contacts = ContactKinds::none;
    scene.comparison.colliding_vertices = true;
    simulate({random_soup(30, 1, 0.6, 4), random_soup(20, 1, 0.6, 5)}, {}, scene, 4)
        .write(folder_ / "paper.h5");
    simulate_solids(4).write(folder_ / "solids.h5");
  }

  /// Reads all of a modified copy and returns the error.
  std::string error_after(const std::function<void(hid_t)>& change, const char* original = "run.h5") const {
    std::filesystem::copy_file(folder_ / original, folder_ / "bad.h5",
                               std::filesystem::copy_options::overwrite_existing);
    const hid_t file = H5Fopen((folder_ / "bad.h5").c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    change(file);
    H5Fclose(file);
    return error_of_reading();
  }

  std::string error_of_reading() const {
    testing::internal::CaptureStderr();
    std::string error;
    try {
      const Recording recording(folder_ / "bad.h5");
      read_contents(recording);
    } catch (const Error& thrown) {
      error = thrown.what();
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "") << "HDF5 prints";
    EXPECT_EQ(error.find('\n'), std::string::npos);
    if (!error.empty()) {
      EXPECT_EQ(error.find((folder_ / "bad.h5").string() + ": "), 0u) << error;
    }
    return error;
  }

  void expect(const std::string& part, const std::function<void(hid_t)>& change,
              const char* original = "run.h5") const {
    const std::string error = error_after(change, original);
    EXPECT_NE(error.find(part), std::string::npos) << "'" << error << "' without '" << part << "'";
  }

  TemporaryFolder folder_;
};

/// Overwrites all values in row `row` of a dataset.
template <class Value>
std::function<void(hid_t)> with_value(const char* path, hsize_t row, Value value, hid_t type) {
  return [=](hid_t file) {
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(dataset);
    hsize_t size[3] = {1, 1, 1}, start[3] = {row, 0, 0};
    const int rank = H5Sget_simple_extent_dims(space, size, nullptr);
    ASSERT_GT(size[0], row) << path;
    size[0] = 1;
    H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, size, nullptr);
    const hid_t memory = H5Screate_simple(rank, size, nullptr);
    const std::vector<Value> values(9, value);
    ASSERT_GE(H5Dwrite(dataset, type, memory, space, H5P_DEFAULT, values.data()), 0) << path;
    H5Sclose(memory);
    H5Sclose(space);
    H5Dclose(dataset);
  };
}

std::function<void(hid_t)> with_number(const char* path, hsize_t row, std::uint64_t value) {
  return with_value(path, row, value, H5T_NATIVE_UINT64);
}

std::function<void(hid_t)> with_rows(const char* path, hsize_t rows) {
  return [=](hid_t file) {
    const hid_t dataset = H5Dopen2(file, path, H5P_DEFAULT), space = H5Dget_space(dataset);
    hsize_t size[3] = {};
    H5Sget_simple_extent_dims(space, size, nullptr);
    size[0] = rows;
    ASSERT_GE(H5Dset_extent(dataset, size), 0) << path;
    H5Sclose(space);
    H5Dclose(dataset);
  };
}

std::function<void(hid_t)> without(const char* path) {
  return [=](hid_t file) { ASSERT_GE(H5Ldelete(file, path, H5P_DEFAULT), 0) << path; };
}

void replace_attribute(hid_t file, const char* name, hid_t type, const void* value) {
  H5Adelete(file, name);
  const hid_t space = H5Screate(H5S_SCALAR);
  const hid_t attribute = H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
  ASSERT_GE(H5Awrite(attribute, type, value), 0);
  H5Aclose(attribute);
  H5Sclose(space);
}

std::function<void(hid_t)> with_attribute(const char* name, std::uint32_t value) {
  return [=](hid_t file) { replace_attribute(file, name, H5T_NATIVE_UINT32, &value); };
}

TEST_F(DamagedRecording, UnchangedIsFine) {
  EXPECT_EQ(error_after([](hid_t) {}), "");
  EXPECT_EQ(error_after([](hid_t) {}, "moving.h5"), "");
  EXPECT_EQ(error_after([](hid_t) {}, "solids.h5"), "");
}

TEST_F(DamagedRecording, OtherFormatsAndVersions) {
  expect("version 5, supple", with_attribute("version", 5));
  expect("or a newer one", with_attribute("version", 5));
  expect("version 0, supple", with_attribute("version", 0));
  expect("attribute leaf_size is 0, not a whole number from 1 to 4294967295", [](hid_t file) {
    const hid_t object = H5Gopen2(file, "objects/0", H5P_DEFAULT);
    const std::uint32_t none = 0;
    replace_attribute(object, "leaf_size", H5T_NATIVE_UINT32, &none);
    H5Gclose(object);
  });
  expect("attribute object_octree is missing", [](hid_t file) {
    const hid_t object = H5Gopen2(file, "objects/0", H5P_DEFAULT);
    H5Adelete(object, "object_octree");
    H5Gclose(object);
  });
  expect("no recording", with_attribute("format", 1));
  expect("no recording", [](hid_t file) { H5Adelete(file, "format"); });
  expect("attribute version is missing", [](hid_t file) { H5Adelete(file, "version"); });
  expect("attribute time_step is missing", [](hid_t file) { H5Adelete(file, "time_step"); });
  expect("attribute contact_points is 7, not a whole number from 0 to 1",
         with_attribute("contact_points", 7));
  expect("attribute contacts is no text", with_attribute("contacts", 7));
  const auto with_word = [](const char* word) {
    return [word](hid_t file) {
      const hid_t type = H5Tcopy(H5T_C_S1);
      H5Tset_size(type, std::strlen(word) + 1);
      replace_attribute(file, "contacts", type, word);
      H5Tclose(type);
    };
  };
  expect("'spheres', which this program does not know", with_word("spheres"));
  expect("'s?heres', which this program does not know", with_word("s\nheres"));
}

TEST_F(DamagedRecording, MissingDatasets) {
  for (const char* path : {"time",
                           "scene_file",
                           "objects",
                           "objects/0",
                           "objects/0/positions",
                           "objects/1/rest_positions",
                           "objects/1/triangles",
                           "object_pairs/end",
                           "object_pairs/object_a",
                           "contacts/end",
                           "contacts/kind",
                           "contacts/normal",
                           "contact_points/position",
                           "continuous_contacts/normal",
                           "continuous_contacts",
                           "events/volume_begin/end",
                           "events/contact_end/object_b",
                           "events/narrow_phase_end/end",
                           "events/narrow_phase_begin/object_a",
                           "colliding_vertices/end",
                           "colliding_vertices/vertex",
                           "colliding_vertex_groups/count_a",
                           "penetration_groups/object_b",
                           "penetrations/end",
                           "penetrations/depth",
                           "vertices_on_surface/vertex",
                           "contained_parts/is_whole",
                           "curves/kind",
                           "curve_contacts/contact",
                           "curve_points/position",
                           "enclosed_vertices/end",
                           "events/penetration_begin/object_a"})
    expect("missing", without(path));
}

TEST_F(DamagedRecording, AMissingStatisticIsNoDamage) {
  EXPECT_EQ(error_after(without("statistics/exact_seconds")), "");
  EXPECT_EQ(Recording(folder_ / "bad.h5").summary(0).stats.exact_seconds, 0);
}

TEST_F(DamagedRecording, CollidingVerticesThatEarlierProgramsDidNotRecordAreNoDamage) {
  const auto change = [](hid_t file) {
    for (const char* path : {"colliding_vertices", "colliding_vertex_groups", "events/narrow_phase_begin",
                             "events/narrow_phase_end"})
      without(path)(file);
  };
  EXPECT_EQ(error_after(change, "paper.h5"), "");
  const RecordedFrame frame = Recording(folder_ / "bad.h5").frame(0);
  EXPECT_TRUE(frame.colliding_vertices.empty() && frame.colliding_vertex_groups.empty() &&
              frame.narrow_phase_events.begin.empty());
  EXPECT_FALSE(frame.object_pairs.empty());
}

TEST_F(DamagedRecording, CollidingVerticesOutOfRange) {
  const auto expect_of_paper = [this](const std::string& path, hsize_t row, std::uint64_t value) {
    expect("/" + path, with_number(path.c_str(), row, value), "paper.h5");
  };
  expect_of_paper("colliding_vertex_groups/object_a", 0, 2);
  expect_of_paper("colliding_vertex_groups/object_b", 1, 99);
  expect_of_paper("colliding_vertex_groups/first_vertex", 2, 4294967295);
  expect_of_paper("colliding_vertex_groups/count_a", 0, 4294967295);
  expect_of_paper("colliding_vertex_groups/count_b", 0, 100000);
  expect_of_paper("colliding_vertices/vertex", 3, 90);
  expect_of_paper("events/narrow_phase_begin/object_b", 0, 2);
  expect("frames name 123456789", with_number("colliding_vertices/end", 3, 123456789), "paper.h5");
  expect("/colliding_vertex_groups", without("colliding_vertices"), "paper.h5");
}

TEST_F(DamagedRecording, PenetrationThatEarlierProgramsDidNotRecordIsNoDamage) {
  const auto change = [](hid_t file) {
    for (const char* path : {"penetration_groups", "penetrations", "vertices_on_surface", "contained_parts",
                             "curves", "curve_contacts", "curve_points", "enclosed_vertices",
                             "events/penetration_begin", "events/penetration_end"})
      without(path)(file);
  };
  EXPECT_EQ(error_after(change, "solids.h5"), "");
  const RecordedFrame frame = Recording(folder_ / "bad.h5").frame(2);
  EXPECT_TRUE(frame.penetrations.empty() && frame.penetration_groups.empty() && frame.curves.empty() &&
              frame.penetration_events.begin.empty());
  EXPECT_FALSE(frame.contacts.empty());
}

TEST_F(DamagedRecording, PenetrationOutOfRange) {
  const auto expect_of_solids = [this](const std::string& path, hsize_t row, std::uint64_t value) {
    expect("/" + path + ": row ", with_number(path.c_str(), row, value), "solids.h5");
  };
  for (const char* column : {"object_a", "object_b", "vertex", "triangle"})
    expect_of_solids(std::string("penetrations/") + column, 5, 100000);
  expect_of_solids("penetrations/feature", 1, 3);
  expect_of_solids("penetrations/feature_index", 1, 3);
  expect_of_solids("penetration_groups/object_a", 0, 4);
  expect_of_solids("penetration_groups/object_b", 0, 4294967295);
  for (const char* column :
       {"first_penetration", "penetration_count", "first_on_surface", "on_surface_count"}) {
    expect_of_solids(std::string("penetration_groups/") + column, 1, 100000);
    expect_of_solids(std::string("penetration_groups/") + column, 1, 4294967295);
  }
  expect_of_solids("vertices_on_surface/vertex", 2, 100000);
  expect_of_solids("contained_parts/object_a", 0, 4);
  expect_of_solids("contained_parts/object_b", 0, 4);
  expect_of_solids("contained_parts/vertex", 0, 26);
  expect_of_solids("contained_parts/vertex_count", 0, 27);
  expect_of_solids("curves/object_a", 0, 4);
  expect_of_solids("curves/object_b", 0, 99);
  expect_of_solids("curves/kind", 0, 3);
  for (const char* column : {"first_contact", "contact_count", "first_point", "point_count", "first_enclosed",
                             "enclosed_count_a", "enclosed_count_b"}) {
    expect_of_solids(std::string("curves/") + column, 1, 100000);
    expect_of_solids(std::string("curves/") + column, 1, 4294967295);
  }
  expect_of_solids("curve_contacts/contact", 3, 100000);
  expect_of_solids("enclosed_vertices/vertex", 2, 100000);
  expect_of_solids("events/penetration_begin/object_b", 0, 4);
  expect("frames name 123456789", with_number("curve_points/end", 3, 123456789), "solids.h5");
  // Rows that refer to a list that is not in the file.
  expect("/penetration_groups/penetration_count", without("penetrations"), "solids.h5");
  expect("/penetration_groups/on_surface_count", without("vertices_on_surface"), "solids.h5");
  expect("/curves/contact_count", without("curve_contacts"), "solids.h5");
  expect("/curves/point_count", without("curve_points"), "solids.h5");
  expect("/curves/enclosed_count_", without("enclosed_vertices"), "solids.h5");
}

TEST_F(DamagedRecording, NumbersOutOfRange) {
  expect("/contacts/object_b: row 0 of frame 0 is 2, not below 2", with_number("contacts/object_b", 0, 2));
  expect("/contacts/object_a", with_number("contacts/object_a", 0, 99));
  expect("/contacts/triangle_a: row 3 of frame 0 is 30, not below 30",
         with_number("contacts/triangle_a", 3, 30));
  expect("/contacts/triangle_b", with_number("contacts/triangle_b", 3, 4000000000));
  expect("/contacts/kind", with_number("contacts/kind", 0, 3));
  expect("/contacts/point_count", with_number("contacts/point_count", 0, 255));
  expect("/contacts/first_point", with_number("contacts/first_point", 0, 4294967295));
  expect("/contact_points/feature_a", with_number("contact_points/feature_a", 1, 3));
  expect("/contact_points/feature_index_b", with_number("contact_points/feature_index_b", 1, 3));
  expect("/object_pairs/object_b", with_number("object_pairs/object_b", 0, 2));
  expect("/events/volume_begin/object_a", with_number("events/volume_begin/object_a", 0, 2));
  expect("/events/contact_begin/object_a", with_number("events/contact_begin/object_a", 0, 1000));
  expect("/objects/0/triangles: row 2 names vertex 4000", with_number("objects/0/triangles", 2, 4000));
  expect("/objects/0/edges: row 1 names vertex 90", with_number("objects/0/edges", 1, 90), "moving.h5");
  expect("/objects/0/points: row 0 names vertex 4000", with_number("objects/0/points", 0, 4000), "moving.h5");
  for (const char* path : {"object_a", "object_b", "kind", "certainty", "element_a", "element_b"})
    expect(path, with_number((std::string("continuous_contacts/") + path).c_str(), 0, 250), "moving.h5");
}

TEST_F(DamagedRecording, EndsThatDoNotAscend) {
  expect("/contacts/end: frame 2 ends at row 0, before the frame before it",
         with_number("contacts/end", 2, 0));
  expect("rows, the frames name 123456789", with_number("object_pairs/end", 3, 123456789));
  expect("rows, the frames name 18446744073709551615",
         with_number("contact_points/end", 3, ~std::uint64_t{0}));
}

TEST_F(DamagedRecording, RowsThatAreNotThere) {
  expect("/contacts/kind", with_rows("contacts/kind", 3));
  expect("/contacts/end", with_rows("contacts/end", 3));
  expect("/statistics/contacts: has 3 frames, the recording has 4", with_rows("statistics/contacts", 3));
  expect("/objects/0/positions: has 2 frames", with_rows("objects/0/positions", 2));
  expect("which are not all in the file", with_rows("time", hsize_t{1} << 50));
  expect("which are not all in the file", with_rows("objects/0/positions", 1000000));
}

TEST_F(DamagedRecording, OtherShapesAndTypes) {
  const auto replaced = [](const char* path, int rank, hid_t type) {
    return [=](hid_t file) {
      H5Ldelete(file, path, H5P_DEFAULT);
      const hsize_t size[3] = {4, 3, 3};
      const hid_t space = H5Screate_simple(rank, size, nullptr);
      const hid_t dataset = H5Dcreate2(file, path, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
      ASSERT_GE(dataset, 0);
      H5Dclose(dataset);
      H5Sclose(space);
    };
  };
  expect("shape (rows)", replaced("time", 2, H5T_NATIVE_DOUBLE));
  expect("shape (rows)", replaced("time", 1, H5T_C_S1));
  expect("shape (rows, 3)", replaced("objects/0/triangles", 1, H5T_NATIVE_UINT32));
  expect("shape (rows, 90, 3)", replaced("objects/0/positions", 3, H5T_NATIVE_DOUBLE));
  expect("/scene_file: is no text", replaced("scene_file", 1, H5T_NATIVE_DOUBLE));
  expect("missing", [](hid_t file) {
    H5Ldelete(file, "time", H5P_DEFAULT);
    H5Gclose(H5Gcreate2(file, "time", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
  });
}

TEST_F(DamagedRecording, CutShortAnywhere) {
  std::ifstream file(folder_ / "run.h5", std::ios::binary);
  const std::string whole(std::istreambuf_iterator<char>(file), {});
  for (std::size_t i = 0; i < 40; ++i) {
    std::ofstream(folder_ / "bad.h5", std::ios::binary) << whole.substr(0, whole.size() * i / 40);
    const std::string error = error_of_reading();
    EXPECT_NE(error.find(i == 0 ? "no recording" : "cut short"), std::string::npos) << error;
  }
}

TEST_F(DamagedRecording, OtherFiles) {
  std::ofstream(folder_ / "bad.h5") << "v 0 0 0\n";
  EXPECT_NE(error_of_reading().find("is no recording (not an HDF5 file)"), std::string::npos);
  std::filesystem::remove(folder_ / "bad.h5");
  EXPECT_NE(error_of_reading().find("there is no such file"), std::string::npos);
  std::filesystem::create_directory(folder_ / "bad.h5");
  EXPECT_NE(error_of_reading().find("is a folder"), std::string::npos);
}

TEST_F(DamagedRecording, ErrorsOfTheCallersOwnCallsArePrintedAsBefore) {
  error_after(without("time"));
  testing::internal::CaptureStderr();
  H5Fopen((folder_ / "nothing").c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  EXPECT_NE(testing::internal::GetCapturedStderr(), "");
}

}  // namespace supple::damaged_recording_test
