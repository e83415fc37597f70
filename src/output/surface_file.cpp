#include "output/surface_file.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>

#include "kernel/parallel.hpp"
#include "output/surface_writers.hpp"

namespace krepl::output {

namespace {

using Kind = SurfaceFormat::Kind;

struct KnownFormat {
  const char* name;
  Kind kind;
};
// Also the extensions.
constexpr KnownFormat known_formats[] = {
    {"json", Kind::json}, {"gpkg", Kind::gpkg}, {"tif", Kind::tif}, {"tiff", Kind::tif},  {"stl", Kind::stl},
    {"ply", Kind::ply},   {"glb", Kind::glb},   {"png", Kind::png}, {"step", Kind::step}, {"stp", Kind::step},
};
constexpr const char* format_list = "json, gpkg, tif, step, stl, ply, glb or png";

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
  return text;
}

Error unknown_format(const std::string& path, const std::string& asked, const std::string& extension) {
  const std::string remedy = std::string("give --format ") + format_list;
  if (!asked.empty()) return {ErrorCode::usage, "unknown format '" + asked + "'", "", remedy};
  if (extension.empty()) {
    return {ErrorCode::usage, path + ": the format of a file without extension is not known", "", remedy};
  }
  return {ErrorCode::usage, path + ": the extension ." + extension + " belongs to no format of surfaces", "", remedy};
}

}  // namespace

Result<SurfaceFormat> find_surface_format(const std::string& path, const std::string& asked) {
  std::string extension = lower(std::filesystem::path(path).extension().string());
  if (!extension.empty()) extension.erase(0, 1);
  std::string name = asked.empty() ? extension : lower(asked);
  if (asked.empty() && path == "-") name = "json";
  for (const KnownFormat& known : known_formats) {
    if (name != known.name) continue;
    SurfaceFormat format{known.kind, known.name};
    if (path == "-" && !format.is_text()) {
      return Error{ErrorCode::usage, "format " + name + " cannot go to standard output", "", "choose json, or name a file"};
    }
    return format;
  }
  return unknown_format(path, lower(asked), extension);
}

const char* name_of(Surface::EdgeKind kind) {
  switch (kind) {
    case Surface::EdgeKind::seam: return "seam";
    case Surface::EdgeKind::valley: return "valley";
    case Surface::EdgeKind::rim: return "rim";
  }
  return "";
}

const char* name_of(Surface::Curve curve) {
  switch (curve) {
    case Surface::Curve::line: return "line";
    case Surface::Curve::circle: return "circle";
    case Surface::Curve::ellipse: return "ellipse";
    case Surface::Curve::quartic: return "quartic";
  }
  return "";
}

const char* name_of(Terrain::FeatureKind kind) {
  switch (kind) {
    case Terrain::FeatureKind::vertex: return "vertex";
    case Terrain::FeatureKind::edge: return "edge";
    case Terrain::FeatureKind::face: return "face";
  }
  return "";
}

std::vector<Surface::Index> visible_features(const Surface& surface) {
  const Subdivision& topology = surface.subdivision();
  std::vector<Surface::Index> features;
  for (std::size_t f = 0; f < topology.face_count(); ++f) features.push_back(surface.face_feature(Surface::Index(f)));
  for (std::size_t e = 0; e < topology.edge_count(); ++e) {
    for (const Surface::Index feature : surface.edge(Surface::Index(e)).feature) features.push_back(feature);
  }
  std::sort(features.begin(), features.end());
  features.erase(std::unique(features.begin(), features.end()), features.end());
  if (!features.empty() && features.back() == Surface::none) features.pop_back();
  return features;
}

Status write_items(OutputStream& stream, std::size_t count, const Context& context,
                   const std::function<void(fmt::memory_buffer&, std::size_t)>& put) {
  constexpr std::size_t block = 512, blocks_at_once = 64;
  std::vector<fmt::memory_buffer> text(blocks_at_once);
  for (std::size_t first = 0; first < count && !stream.failed(); first += block * blocks_at_once) {
    const std::size_t here = std::min(count - first, block * blocks_at_once);
    const bool done = kernel::parallel_blocks(context, here, block, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) put(text[begin / block], first + i);
    });
    if (!done) return surface_interrupted();
    for (fmt::memory_buffer& part : text) {
      stream.write({part.data(), part.size()});
      part.clear();
    }
    if (context.progress) context.progress(double(first + here) / double(count));
  }
  return std::monostate{};
}

namespace {

using Buffers = std::vector<fmt::memory_buffer>;

/// One buffer a section for each of several items, filled on all threads.
Status fill(std::vector<Buffers>& items, std::size_t first, std::size_t count, const Context& context,
            const std::function<void(std::span<fmt::memory_buffer>, std::size_t)>& put) {
  const bool done = kernel::parallel_blocks(context, count, 1, [&](std::size_t i, std::size_t) {
    for (fmt::memory_buffer& buffer : items[i]) buffer.clear();
    put(items[i], first + i);
  });
  if (!done) return surface_interrupted();
  return std::monostate{};
}

}  // namespace

Status write_sections(OutputStream& stream, std::span<const std::uint64_t> sizes, std::size_t count,
                      const Context& context,
                      const std::function<void(std::span<fmt::memory_buffer>, std::size_t)>& put) {
  constexpr std::uint64_t bytes_at_once = 4 << 20;
  constexpr std::size_t least = 8, most = 64;
  const std::uint64_t bytes = std::reduce(sizes.begin(), sizes.end());
  const std::size_t batch =
      std::clamp(std::size_t(bytes_at_once * count / std::max<std::uint64_t>(bytes, 1)), least, most);
  std::vector<Buffers> items(batch);
  for (Buffers& item : items) item = Buffers(sizes.size());
  std::vector<std::uint64_t> place(sizes.size());
  const bool at_once = stream.can_seek();
  std::exclusive_scan(sizes.begin(), sizes.end(), place.begin(), at_once ? stream.position() : 0);
  const std::size_t passes = at_once ? 1 : sizes.size();
  for (std::size_t pass = 0; pass < passes; ++pass) {
    for (std::size_t first = 0; first < count && !stream.failed(); first += batch) {
      const std::size_t here = std::min(count - first, batch);
      if (Status filled = fill(items, first, here, context, put); !filled) return filled;
      for (std::size_t s = at_once ? 0 : pass; s < (at_once ? sizes.size() : pass + 1); ++s) {
        if (at_once) stream.seek(place[s]);
        for (std::size_t i = 0; i < here; ++i) {
          stream.write({items[i][s].data(), items[i][s].size()});
          place[s] += items[i][s].size();
        }
      }
      if (context.progress) context.progress(double(pass * count + first + here) / double(passes * count));
    }
  }
  return std::monostate{};
}

std::optional<std::string> size_warning(const Surface& surface, const SurfaceFormat& format) {
  constexpr std::size_t most_faces = 50'000;
  const std::size_t faces = surface.subdivision().face_count();
  if (format.kind != Kind::step || faces <= most_faces) return std::nullopt;
  return fmt::format(
      "warning: {} faces; CAD programs take minutes and gigabytes for STEP of more than {}. Take a part of the "
      "terrain or a larger radius, or glb",
      faces, most_faces);
}

SurfaceWriteResult write_surface(const std::string& path, const Surface& surface, const SurfaceFormat& format,
                                 const SurfaceFileOptions& options, const Context& context) {
  if (options.curve_points < 3) return Error{ErrorCode::usage, "an edge has 3 points or more", "", ""};
  if (context.cancelled()) return surface_interrupted();
  switch (format.kind) {
    case Kind::json: return write_surface_json(path, surface, options, context);
    case Kind::gpkg: return write_surface_gpkg(path, surface, options, context);
    case Kind::tif:
      return write_heights(path, {std::shared_ptr<void>(), &surface.terrain()}, surface.radius(), options, context);
    case Kind::stl: return write_surface_stl(path, surface, options, context);
    case Kind::ply: return write_surface_ply(path, surface, options, context);
    case Kind::glb: return write_surface_glb(path, surface, options, context);
    case Kind::png: return write_surface_png(path, surface, options, context);
    case Kind::step:
      return write_surface_step(path, surface, options, context);
  }
  return Error{ErrorCode::usage, "unknown format", "", ""};
}

}  // namespace krepl::output
