#pragma once

#include <hdf5.h>

#include <filesystem>

#include "hdf5_handles.hpp"

// A file driver of HDF5 under which a file is whole at any moment.
//
// HDF5 appends to a file by writing new blocks at its end and by changing blocks that are there already: the
// sizes of datasets and the nodes of the B-trees that find their chunks. A process that is killed between two
// of these leaves a file that no one reads. This driver holds back every change of metadata that the last
// flush left in the file, and at the next flush makes the changes in such an order that the file is valid
// after each single one:
//
//   1. everything new is in the file already, beyond what the old metadata know of;
//   2. the superblock, so that the file's end is beyond all of it;
//   3. B-tree nodes, parents first: a node that was split holds more than its parent says until its turn
//   comes, and
//      whatever is looked for is in the child that either parent names;
//   4. headers of datasets, by address: only now rows exist. The dataset created last grows last.
//
// No block of metadata crosses a page of memory, so that the kernel does not stop in the middle of one when
// it ends the process. Nothing is promised about a machine that loses power: nothing waits for the disk.

namespace supple {

/// Creates the file, or empties it. The handle is invalid when that fails; `errno` says why.
FileHandle create_committed_file(const std::filesystem::path& path);

/// The `errno` of the first write that failed, 0 when none has. HDF5 itself is not told: ask after each call
/// that may write. Nothing written from then on reaches the file.
int write_error(hid_t file);

/// Nothing reaches the file any more: it stays as the last flush left it.
void discard_writes(hid_t file);

}  // namespace supple
