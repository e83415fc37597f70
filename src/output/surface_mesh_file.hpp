#pragma once

// What the writers of triangles share.

#include <bit>
#include <cstdint>
#include <cstring>
#include <functional>

#include "output/surface_mesh.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

static_assert(std::endian::native == std::endian::little, "binary formats are written as they are in memory");

template <class Value>
void put_binary(fmt::memory_buffer& bytes, Value value) {
  const char* first = reinterpret_cast<const char*>(&value);
  bytes.append(first, first + sizeof value);
}

/// Colour of a face by what the ball touches, as in the picture: sand for faces, blue for edges, red for vertices.
std::array<std::uint8_t, 3> patch_colour(Terrain::FeatureKind kind);

/// Makes the triangles within the deviation asked for, has `put` write them, and finishes the file. What `put` adds to the
/// report comes after what is told about the triangles.
SurfaceWriteResult write_mesh(const std::string& path, const Surface& surface, const SurfaceFileOptions& options,
                              const Context& context,
                              const std::function<Status(OutputStream&, const SurfaceMesh&, SurfaceFileReport&)>& put);

/// Where float coordinates are written: a place near the middle to take off, if floats could not hold the coordinates to a
/// fiftieth of the deviation asked for; else zero.
Point3 float_origin(const Surface& surface, double max_error);

}  // namespace krepl::output
