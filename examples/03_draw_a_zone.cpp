// Writes a zone with true arcs as SVG, to standard output: one path, each ring a sequence of L and A commands.
#include <cstdio>
#include <krepl/network.hpp>
#include <krepl/zone.hpp>
#include <memory>
#include <utility>

namespace {

void draw_piece(const krepl::Zone::Piece& piece, double radius) {
  if (piece.kind == krepl::Zone::Kind::segment) {
    std::printf("L%.17g %.17g ", piece.end.x, piece.end.y);
    return;
  }
  // SVG cannot say "full circle", and a half or more needs its large-arc flag: go by way of the opposite point if so.
  const double ax = piece.start.x - piece.center.x, ay = piece.start.y - piece.center.y;
  const double bx = piece.end.x - piece.center.x, by = piece.end.y - piece.center.y;
  if (ax * by - ay * bx <= 0)
    std::printf("A%.17g %.17g 0 0 1 %.17g %.17g ", radius, radius, piece.center.x - ax, piece.center.y - ay);
  std::printf("A%.17g %.17g 0 0 1 %.17g %.17g ", radius, radius, piece.end.x, piece.end.y);
}

void draw(const krepl::Zone& zone) {
  std::printf("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"-30 -30 160 160\">\n"
              "<path transform=\"matrix(1 0 0 -1 0 100)\" fill-rule=\"evenodd\" fill=\"#9cf\" stroke=\"#047\" d=\"");
  for (std::uint32_t ring = 0; ring < zone.ring_count(); ++ring) {
    const krepl::Point start = zone.piece(zone.ring_begin(ring)).start;
    std::printf("M%.17g %.17g ", start.x, start.y);
    for (std::uint32_t e = zone.ring_begin(ring); e < zone.ring_begin(ring + 1); ++e) draw_piece(zone.piece(e), zone.radius());
    std::printf("Z ");
  }
  std::printf("\"/>\n</svg>\n");
}

}  // namespace

int main() {
  const krepl::Point square[] = {{0, 0}, {100, 0}, {100, 100}, {0, 100}, {0, 0}};
  krepl::Network::Builder builder;
  builder.add_line(square);
  builder.add_point({50, 50});
  auto network = std::move(builder).build();
  if (!network) return std::fprintf(stderr, "%s\n", network.error().text().c_str()), 1;
  const auto zone =
      krepl::compute_zone(std::make_shared<const krepl::Network>(std::move(*network)), {.radius = 20});
  if (!zone) return std::fprintf(stderr, "%s\n", zone.error().text().c_str()), 1;
  draw(*zone);
  return 0;
}
