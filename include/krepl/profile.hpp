#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/point.hpp"

namespace krepl {

/// The sum of a 2D terrain and a disk (thesis chapter 2; docs/profile.md).
///
/// A terrain is a polyline v0 v1 ... vn with non-decreasing x and everything below it solid. Equal x (a cliff), repeated
/// points, a single point and flat ground are ordinary input. The sum with a disk of radius R is a terrain again, over
/// [x0 - R, xn + R]; its upper boundary is a chain of pieces from left to right: a half-line up from -inf, offset segments
/// and clockwise arcs, a half-line down to -inf. It has at most 2n + 2 vertices (theorem 2.3.4).
///
/// Every vertex is correct to a few units in the last place of the coordinates and of R, measured as its distance from both
/// curves that meet in it. Along them, where they are nearly tangent, its place is certain to 2^-42 (R + d) only, d the sum
/// |dx| + |dy| between the two input vertices that cause it (2^-48 (R + d) on ordinary data). Pieces too short to be seen
/// in double precision are left out; neighbours then share the vertex.
struct ProfilePiece {
  enum class Kind : std::uint8_t { half_line, segment, arc };
  Point start;          ///< the piece ends where the next one starts
  std::uint32_t index;  ///< segment v(index) v(index+1) for Kind::segment, else the vertex that causes the piece
  Kind kind;

  friend bool operator==(const ProfilePiece&, const ProfilePiece&) = default;
};
static_assert(sizeof(ProfilePiece) == 24, "the cost of a large profile is memory traffic");

/// A piece with everything said in full.
struct ProfileRow {
  ProfilePiece::Kind kind = ProfilePiece::Kind::half_line;
  Point start, end;  ///< the lower end of a half-line has y = -infinity
  Point center;      ///< arcs only (NaN for others): the arc runs clockwise about it with radius R
  std::uint32_t index = 0;
};
/// "s3" for what segment 3 causes, "v4" for what vertex 4 does.
std::string profile_cause(const ProfileRow& row);

/// Piece k in full. Preconditions: `pieces` is the whole result for `terrain`, k < pieces.size().
ProfileRow profile_row(std::span<const Point> terrain, std::span<const ProfilePiece> pieces, std::size_t k);

/// The vertices of a result: pieces.size() - 1 in all. An explicit one is a crossing of two pieces that do not continue
/// each other smoothly; at most n - 1 of them.
struct ProfileVertexCounts {
  std::size_t all = 0;
  std::size_t explicit_ones = 0;
};
ProfileVertexCounts count_profile_vertices(std::span<const Point> terrain, std::span<const ProfilePiece> pieces);

/// Pieces that suffice for any terrain of so many points: 2n + 3 with n = points - 1.
constexpr std::size_t profile_capacity(std::size_t points) { return 2 * points + 1; }

/// What the work cost and how often each rung of the ladder of predicates was needed.
struct ProfileCounters {
  std::uint64_t segments = 0;           ///< segments of positive length
  /// Pieces that a later segment took off the stack. Not counted: the arc at that segment's own start, which every valley
  /// hides, and what joining blocks drops. Counted twice: pops by repeated segments.
  std::uint64_t pops = 0;
  std::uint64_t in_double_double = 0;   ///< decisions and crossings that double precision left open
  std::uint64_t ties = 0;               ///< of those, true ties: the piece of length zero is dropped
  std::uint64_t collapsed_pieces = 0;   ///< pieces dropped because they have no length in double precision
  std::uint64_t largest_stack = 0;      ///< most pieces open at once (the window's size), or kept by a block for joining
  std::uint64_t replayed_segments = 0;  ///< segments done twice where blocks could not be joined at once (parallel)
};

/// Computes profiles one after the other with the same working memory.
class ProfileEngine {
 public:
  ProfileEngine();
  ~ProfileEngine();
  ProfileEngine(ProfileEngine&&) noexcept;
  ProfileEngine& operator=(ProfileEngine&&) noexcept;

  /// Writes the pieces to `out` (at least profile_capacity(terrain.size()) of them) and returns how many there are.
  ///
  /// Linear time. Working memory is 64 bytes per piece in the window of width R that is still open, kept for the next
  /// call; nothing is allocated per segment. With context.threads == 1 the stack runs over the whole terrain; with more
  /// threads blocks are built separately and joined at one crossing each, with the same bits as the result.
  ///
  /// Errors: radius not in [1e-140, 1e140] (usage); no point; x decreases or a coordinate is not finite or above 1e140 in
  /// absolute value (the vertex is named); more than 2^31 - 1 points; `out` too small; cancelled.
  Result<std::size_t> compute(std::span<const Point> terrain, double radius, std::span<ProfilePiece> out,
                              const Context& context = {});

  const ProfileCounters& counters() const;

  /// Segments in a block of the parallel version, which is then used on one thread too; 0 (the default) chooses. For tests
  /// and measurements; changes no bit of a result.
  void set_block_size(std::size_t segments);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A terrain with its sum.
struct Profile {
  double radius = 0;
  std::vector<Point> terrain;
  std::vector<ProfilePiece> pieces;
  ProfileCounters counters;
  ProfileRow row(std::size_t k) const { return profile_row(terrain, pieces, k); }
};
/// ProfileEngine::compute with storage of its own; the same errors.
Result<Profile> compute_profile(std::vector<Point> terrain, double radius, const Context& context = {});

/// The same computation for a terrain that does not fit into memory, or is still being measured: points go in, at most
/// 2^31 - 1 of them, and each piece comes out as soon as no later point can change it. Holds the open window of width R
/// only; the same bits as ProfileEngine.
class ProfileStream {
 public:
  /// Called with finished pieces, from left to right.
  using Sink = std::function<void(std::span<const ProfileRow>)>;
  /// Errors: radius not in [1e-140, 1e140].
  static Result<ProfileStream> open(double radius, Sink sink);
  ~ProfileStream();
  ProfileStream(ProfileStream&&) noexcept;
  ProfileStream& operator=(ProfileStream&&) noexcept;

  /// Errors as ProfileEngine::compute, naming the vertex by its number in the stream; nothing more may be pushed then.
  Status push(std::span<const Point> points);
  Status push(Point point) { return push(std::span<const Point>(&point, 1)); }
  /// Hands the rest to the sink. Error: no point was pushed.
  Status finish();

  const ProfileCounters& counters() const;

 private:
  struct State;
  explicit ProfileStream(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace krepl
