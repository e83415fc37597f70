#pragma once

// The writers behind write_surface, one a format, and what they share.

#include <fmt/format.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>

#include "krepl/context.hpp"
#include "krepl/surface.hpp"
#include "output/output_stream.hpp"
#include "output/surface_file.hpp"

namespace krepl::output {

using SurfaceWriteResult = Result<SurfaceFileReport>;

inline Error surface_interrupted() { return {ErrorCode::cancelled, "interrupted while writing", "", ""}; }
inline Error too_many_vertices() {
  return {ErrorCode::computation, "the mesh would have more than 2^32 vertices", "", "give a larger --max-error"};
}

inline double surface_max_error(const SurfaceFileOptions& options, double radius) {
  return options.max_error > 0 ? options.max_error : radius / 1000;
}

/// Features that own a face or a side of an edge, in order of their numbers.
std::vector<Surface::Index> visible_features(const Surface& surface);

/// Bytes of `count` items, made on all threads by put(buffer, item) and written in their order.
Status write_items(OutputStream& stream, std::size_t count, const Context& context,
                   const std::function<void(fmt::memory_buffer&, std::size_t)>& put);

/// Bytes of `count` items that belong to several sections of a file, one after the other and of these sizes:
/// put(buffers, item) appends to one buffer a section. A file is filled in all sections at once; for a pipe, items are
/// made once for each.
Status write_sections(OutputStream& stream, std::span<const std::uint64_t> sizes, std::size_t count,
                      const Context& context,
                      const std::function<void(std::span<fmt::memory_buffer>, std::size_t)>& put);

SurfaceWriteResult write_surface_json(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_gpkg(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_stl(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_ply(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_glb(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_png(const std::string& path, const Surface&, const SurfaceFileOptions&, const Context&);
SurfaceWriteResult write_surface_step(const std::string& path, const Surface&, const SurfaceFileOptions&,
                                      const Context&);

}  // namespace krepl::output
