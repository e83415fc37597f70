// A terrain that never has to be in memory: points go in as they are measured, finished pieces come out.
#include <cmath>
#include <cstdio>
#include <krepl/profile.hpp>

int main() {
  std::size_t pieces = 0;
  double highest = -INFINITY;
  auto stream = krepl::ProfileStream::open(2.5, [&](std::span<const krepl::ProfileRow> rows) {
    pieces += rows.size();
    for (const krepl::ProfileRow& row : rows)
      if (row.kind == krepl::ProfilePiece::Kind::arc) highest = std::fmax(highest, row.center.y + 2.5);
  });
  if (!stream) return std::fprintf(stderr, "%s\n", stream.error().text().c_str()), 1;
  for (int i = 0; i <= 100'000; ++i)
    if (const auto status = stream->push({0.5 * i, std::sin(0.01 * i) * 10}); !status)
      return std::fprintf(stderr, "%s\n", status.error().text().c_str()), 1;
  if (const auto status = stream->finish(); !status) return std::fprintf(stderr, "%s\n", status.error().text().c_str()), 1;
  std::printf("%zu pieces, at most %llu held at once, highest place of the centre %.4f\n", pieces,
              static_cast<unsigned long long>(stream->counters().largest_stack), highest);
  return 0;
}
