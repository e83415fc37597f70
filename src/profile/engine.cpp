// The sequential and the parallel run over a terrain in memory.
#include <algorithm>
#include <optional>
#include <thread>

#include "kernel/parallel.hpp"
#include "profile/check.hpp"
#include "profile/join.hpp"

namespace krepl {

using profile::Sweep;

namespace {

constexpr std::size_t default_block = std::size_t{1} << 16;
/// Batches between two looks at cancel and progress.
constexpr std::size_t batches_at_a_time = 512;

/// Writes pieces one after the other.
struct PieceWriter {
  ProfilePiece* next;
  void operator()(ProfilePiece::Kind kind, std::uint32_t index, Point, Point start, Point) {
    *next++ = {start, index, kind};
  }
};

/// A run of segments with its own sweep; buffers are kept from block to block.
struct Block {
  Sweep sweep;
  std::vector<ProfilePiece> pieces;
  std::size_t first = 0, last = 0;  // vertices, both included
  std::size_t piece_count = 0;      // handed out by the sweep itself
  std::size_t bad_vertex = 0;       // 0: none
  ProfilePiece* target = nullptr;   // where the pieces belong
};

void add(ProfileCounters& sum, const ProfileCounters& c) {
  sum.segments += c.segments;
  sum.pops += c.pops;
  sum.in_double_double += c.in_double_double;
  sum.ties += c.ties;
  sum.largest_stack = std::max(sum.largest_stack, c.largest_stack);
  sum.replayed_segments += c.replayed_segments;
}

Error cancelled_error() { return {ErrorCode::cancelled, "cancelled", "", ""}; }

}  // namespace

struct ProfileEngine::State {
  Sweep sweep;
  std::vector<Block> blocks;
  ProfileCounters counters;
  std::size_t block_size = default_block;
  bool always_blocks = false;  // even on one thread

  std::span<const Point> terrain;
  double radius = 0;

  /// Appends vertices first .. last to the main sweep and hands out what is final. Returns the first bad one, or last + 1.
  std::size_t extend(std::size_t first, std::size_t last, PieceWriter& write) {
    while (first <= last) {
      const std::size_t count = std::min(Sweep::batch, last + 1 - first);
      const std::size_t taken = sweep.append(&terrain[first], count, std::uint32_t(first));
      sweep.settle(write);
      first += taken;
      if (taken < count) break;
    }
    return first;
  }

  std::optional<Error> run_alone(PieceWriter& write, const Context& context) {
    kernel::Progress progress(context, terrain.size());
    sweep.start(radius, terrain[0], 0, false);
    for (std::size_t first = 1; first < terrain.size();) {
      if (context.cancelled()) return cancelled_error();
      const std::size_t last = std::min(terrain.size() - 1, first + batches_at_a_time * Sweep::batch - 1);
      const std::size_t next = extend(first, last, write);
      if (next <= last) return profile::vertex_error(next, terrain[next], &terrain[next - 1]);
      progress.add(next - first);
      first = next;
    }
    return std::nullopt;
  }

  void run_block(Block& block, const Context& context) {
    block.pieces.resize(std::max(block.pieces.size(), profile_capacity(block_size + 1)));
    PieceWriter write{block.pieces.data()};
    block.bad_vertex = 0;
    block.sweep.start(radius, terrain[block.first], std::uint32_t(block.first), true);
    std::size_t batches = 0;
    for (std::size_t next = block.first + 1; next <= block.last;) {
      if (++batches % batches_at_a_time == 0 && context.cancelled()) return;
      const std::size_t count = std::min(Sweep::batch, block.last + 1 - next);
      const std::size_t taken = block.sweep.append(&terrain[next], count, std::uint32_t(next));
      next += taken;
      if (taken < count) {
        block.bad_vertex = next;
        return;
      }
      block.sweep.settle(write);
    }
    block.piece_count = std::size_t(write.next - block.pieces.data());
  }

  /// Joins a block to what lies left of it; the block's own pieces get their place behind what was written.
  void fold(Block& block, PieceWriter& write) {
    bool joined;
    if (block.first == 0) {
      sweep.start(radius, terrain[0], 0, false);
      joined = sweep.take(block.sweep, write);
    } else {
      joined = sweep.join(block.sweep, write);
    }
    std::size_t step = 16;
    for (std::size_t next = block.first + 1; !joined && next <= block.last; step = std::min(2 * step, Sweep::batch)) {
      const std::size_t count = std::min(step, block.last + 1 - next);
      sweep.append(&terrain[next], count, std::uint32_t(next));
      counters.replayed_segments += count;
      next += count;
      joined = sweep.join_repeated(block.sweep, write);
      if (!joined) sweep.settle(write);  // not before: what is handed out cannot agree any more
    }
    block.target = write.next;
    if (!joined) block.piece_count = 0;
    write.next += block.piece_count;
    sweep.settle(write);
    add(counters, block.sweep.counters());
  }

  std::optional<Error> run_blocks(PieceWriter& write, const Context& context, unsigned threads) {
    const std::size_t segments = terrain.size() - 1;
    const std::size_t total = (segments + block_size - 1) / block_size;
    blocks.resize(std::max(blocks.size(), std::min<std::size_t>(total, 4 * threads)));
    kernel::Progress progress(context, total);
    for (std::size_t done = 0; done < total;) {
      const std::size_t wave = std::min(blocks.size(), total - done);
      for (std::size_t b = 0; b < wave; ++b) {
        blocks[b].first = (done + b) * block_size;
        blocks[b].last = std::min(segments, blocks[b].first + block_size);
      }
      if (!kernel::parallel_blocks(context, wave, 1, [&](std::size_t b, std::size_t) { run_block(blocks[b], context); }))
        return cancelled_error();
      for (std::size_t b = 0; b < wave; ++b) {
        if (const std::size_t bad = blocks[b].bad_vertex; bad != 0)
          return profile::vertex_error(bad, terrain[bad], &terrain[bad - 1]);
        fold(blocks[b], write);
      }
      kernel::parallel_blocks(context, wave, 1, [&](std::size_t b, std::size_t) {
        std::copy_n(blocks[b].pieces.data(), blocks[b].piece_count, blocks[b].target);
      });
      progress.add(wave);
      done += wave;
    }
    return std::nullopt;
  }
};

ProfileEngine::ProfileEngine() : state_(std::make_unique<State>()) {}
ProfileEngine::~ProfileEngine() = default;
ProfileEngine::ProfileEngine(ProfileEngine&&) noexcept = default;
ProfileEngine& ProfileEngine::operator=(ProfileEngine&&) noexcept = default;

const ProfileCounters& ProfileEngine::counters() const { return state_->counters; }

void ProfileEngine::set_block_size(std::size_t segments) {
  state_->always_blocks = segments != 0;
  state_->block_size = segments != 0 ? segments : default_block;
}

Result<std::size_t> ProfileEngine::compute(std::span<const Point> terrain, double radius, std::span<ProfilePiece> out,
                                           const Context& context) {
  if (Status status = profile::check_radius(radius); !status) return status.error();
  if (terrain.empty()) return profile::no_vertex_error();
  if (terrain.size() > profile::most_vertices) return profile::too_many_vertices_error();
  if (!profile::usable(terrain[0])) return profile::vertex_error(0, terrain[0], nullptr);
  if (out.size() < profile_capacity(terrain.size()))
    return Error{ErrorCode::usage, "the storage for pieces is too small", "", "provide profile_capacity(points) pieces"};
  State& s = *state_;
  s.terrain = terrain;
  s.radius = radius;
  s.counters = {};
  PieceWriter write{out.data()};
  const unsigned threads = context.threads != 0 ? context.threads : std::max(1u, std::thread::hardware_concurrency());
  const bool few = threads == 1 || terrain.size() <= s.block_size + 1;
  const bool alone = terrain.size() == 1 || (few && !s.always_blocks);
  if (std::optional<Error> error = alone ? s.run_alone(write, context) : s.run_blocks(write, context, threads))
    return *error;
  s.sweep.finish(write);
  s.counters.collapsed_pieces = s.sweep.dropped_pieces();
  add(s.counters, s.sweep.counters());
  if (!alone) s.counters.segments -= s.sweep.counters().segments;  // repeated ones were counted in their blocks
  return std::size_t(write.next - out.data());
}

}  // namespace krepl
