// The zone of a small river: every place within 50 m of it, with a boundary of true segments and arcs.
#include <cstdio>
#include <krepl/network.hpp>
#include <krepl/zone.hpp>
#include <memory>
#include <utility>

int main() {
  // Two streams that meet, in metres. Lines may cross, branch, overlap and repeat.
  const krepl::Point main_stream[] = {{0, 0}, {200, 0}, {400, 0}};
  const krepl::Point tributary[] = {{200, 150}, {200, 0}};
  krepl::Network::Builder builder;
  builder.add_line(main_stream, 1);  // the numbers are the caller's: they lead back from a piece to its feature
  builder.add_line(tributary, 2);
  auto network = std::move(builder).build();
  if (!network) return std::fprintf(stderr, "%s\n", network.error().text().c_str()), 1;

  const auto river = std::make_shared<const krepl::Network>(std::move(*network));
  const auto zone = krepl::compute_zone(river, {.radius = 50});
  if (!zone) return std::fprintf(stderr, "%s\n", zone.error().text().c_str()), 1;

  std::printf("area %.3f, boundary %.3f, holes %zu\n", zone->area(), zone->perimeter(), zone->hole_count());
  for (std::uint32_t e = 0; e < zone->piece_count(); ++e) {
    const auto piece = zone->piece(e);
    const bool arc = piece.kind == krepl::Zone::Kind::arc;
    const auto source = arc ? river->vertex_source(piece.source) : river->segment_source(piece.source);
    std::printf("%-7s (%g, %g) to (%g, %g) from stream %lld\n", arc ? "arc" : "segment", piece.start.x, piece.start.y,
                piece.end.x, piece.end.y, static_cast<long long>(source.feature));
  }
  return 0;
}
