#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "input/result_file.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/point.hpp"
#include "view/profile_rows.hpp"

namespace krepl::view {

/// What a piece of a drawn chain is; the numbers are those of the page's script (page/decode.js).
enum class PieceKind : std::uint8_t { segment = 0, arc_left = 1, arc_right = 2, half_line = 3 };

/// How a chain takes part in the picture; the numbers are those of the page's script.
enum class ChainKind : std::uint8_t { outer = 0, hole = 1, open = 2 };

/// Chains of true pieces that are shown and hidden together: the zone of one radius, a profile, the input.
/// Chain c has the vertices vertex_begin[c] .. vertex_begin[c+1], one more than pieces (rings repeat the first vertex);
/// its piece i starts at vertex vertex_begin[c] + i and has the index vertex_begin[c] - c + i in the arrays by piece.
struct Layer {
  static constexpr std::uint32_t unknown = ~std::uint32_t{0};

  std::string role;  ///< "zone", "profile" or "input"
  std::string name;
  std::optional<double> radius;
  std::vector<Point> vertices;
  std::vector<std::uint32_t> vertex_begin{0};
  std::vector<ChainKind> chain_kind;
  std::vector<PieceKind> kind;               ///< by piece
  std::vector<Point> centers;                ///< one for each arc, in the order of the pieces
  std::vector<std::uint32_t> source_part;    ///< by piece: index into `parts`, or unknown; empty if none is known
  std::vector<std::uint32_t> source_vertex;  ///< by piece: vertex, or first vertex of the segment, within that part
  struct Part {
    std::int64_t feature = -1, part = -1;  ///< -1: unknown
    friend bool operator==(const Part&, const Part&) = default;
  };
  std::vector<Part> parts;  ///< where pieces come from; for the role "input": by chain

  std::size_t polygons = 0;
  double area = 0;       ///< zones: of the polygons, holes taken off
  double perimeter = 0;  ///< length of all pieces of finite length

  std::size_t chain_count() const { return chain_kind.size(); }
  std::size_t count(PieceKind wanted) const;
  std::size_t arc_count() const { return count(PieceKind::arc_left) + count(PieceKind::arc_right); }
  std::size_t hole_count() const;
};

/// All that a page shows, the layers from bottom to top.
struct PageData {
  std::string title;
  std::string crs;   ///< name of the coordinate system; empty if unknown
  std::string unit;  ///< short name of the unit of length, as "m"; empty if unknown
  std::vector<Layer> layers;
};

/// A layer for each zone, the largest radius first (below the others). Errors: nothing to show; a coordinate that is
/// not finite; more than 2^31 pieces in a layer.
Result<std::vector<Layer>> zone_layers(const std::vector<input::ResultZone>& zones);

/// The profile as one chain. Its radius is that of its first arc. Errors: as zone_layers.
Result<Layer> profile_layer(const std::vector<ProfileRow>& rows);

/// The lines and rings of the input, as they were given.
Layer input_layer(const Network& network);

/// The points of a profile's terrain, one line.
Layer terrain_layer(const std::vector<Point>& terrain);

}  // namespace krepl::view
