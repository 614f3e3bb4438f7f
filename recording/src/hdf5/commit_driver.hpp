#pragma once

#include <hdf5.h>

#include <filesystem>

#include "hdf5/handles.hpp"

// An HDF5 file driver that keeps a file valid at any moment.
//
// HDF5 appends to a file in two ways: it writes new blocks at the end, and it changes existing blocks,
// namely the sizes of datasets and the nodes of the B-trees that index their chunks. A process killed
// between two such writes leaves a file that nobody can read. This driver holds back every change to
// metadata that the last flush wrote. At the next flush it writes the changes in an order in which each
// single write leaves a valid file:
//
//   1. New blocks. They are in the file already, but old metadata does not refer to them.
//   2. The superblock, so that the end of the file is after all new blocks.
//   3. B-tree nodes, parents first. The old version of a split node still contains all its keys until its
//      new version is written. So each key is in the child to which its parent refers, old or new.
//   4. Headers of datasets, by address. This makes the new rows visible. The dataset created last grows last.
//
// No block of metadata crosses a page of memory, so the kernel does not stop within a block when it ends the
// process. The driver does not protect against power loss: it does not wait for the disk.

namespace supple {

/// Creates or truncates the file. On failure the handle is invalid and `errno` has the reason.
FileHandle create_committed_file(const std::filesystem::path& path);

/// The `errno` of the first failed write, or 0. HDF5 is not notified of failures, so check after each call
/// that may write. After a failure nothing more is written to the file.
int write_error(hid_t file);

/// Stops writing to the file; it stays as the last flush left it.
void discard_writes(hid_t file);

}  // namespace supple
