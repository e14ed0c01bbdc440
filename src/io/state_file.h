#pragma once

#include "grains/snapshot.h"
#include "io/atomic_file.h"

#include <string>

namespace sandflow {

/// Writes a snapshot so that it comes back bit for bit. Layout, little-endian:
///
///     "SANDSTAT"  u32 version
///     u64 frame   f64 time   f64 meanRadius   u64 emitted   u64 exited   u64 n   u64 moving
///     n x u32     id
///     n x u8      state in bits 0-1, bit 7: the grain has a velocity or a spin
///     n x f32     radius
///     n x 3 f64   position
///     moving x 6 f32   velocity and spin of those with bit 7, in the order of the grains
///     u32         CRC-32 of everything before it
///
/// Throws SystemError if the disk refuses the file, InternalError if the arrays of the snapshot
/// differ in length or its ids do not ascend.
void writeState(const std::string& path, const Snapshot& snapshot,
                Durability durability = Durability::buffered);

/// Reads what writeState wrote. Throws InputError for a file that is missing, foreign, truncated,
/// of another version or damaged in any bit.
Snapshot readState(const std::string& path);

}  // namespace sandflow
