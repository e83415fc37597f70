#include <algorithm>
#include <numeric>
#include <optional>

#include "kernel/parallel.hpp"
#include "krepl/sweep.hpp"
#include "sweep/overlaps.hpp"
#include "sweep/paths.hpp"
#include "sweep/pieces.hpp"
#include "sweep/plane_sweep.hpp"
#include "zone/assembly.hpp"
#include "zone/precision.hpp"

namespace krepl {
namespace sweep {
namespace {

constexpr Index longest_path = 16;  // segments that the first round unites
constexpr Index fan = 8;            // outlines that each further round unites
constexpr std::uint64_t unlimited = ~std::uint64_t{0};

void add(SweepCounters& total, const SweepCounters& part) {
  total.curves += part.curves;
  total.crossings += part.crossings;
  total.decisions += part.decisions;
  total.decided_in_quadruple += part.decided_in_quadruple;
  total.decided_in_320_bits += part.decided_in_320_bits;
  total.ties += part.ties;
}

std::size_t curves_of(const std::vector<Outline>& outlines) {
  return std::accumulate(outlines.begin(), outlines.end(), std::size_t{0},
                         [](std::size_t n, const Outline& o) { return n + o.curves.size(); });
}

class Union {
 public:
  Union(const Geometry& geometry, const Context& context, SweepCounters& counters)
      : geometry_(geometry), context_(context), counters_(counters) {}

  /// As the thesis has it: all cigars at once.
  Result<Outline> at_once(std::uint64_t most) {
    const Paths paths = take_apart(geometry_.instance(), none);
    counters_.paths = paths.count();
    Predicates predicates(geometry_);
    outlines_.resize(paths.count());
    for (Index p = 0; p < paths.count(); ++p) outlines_[p] = outline_of_path(paths, p, predicates);
    add(counters_, predicates.counters);
    auto all = sweep_all(most);
    if (!all) return all.error();
    if (*all) return std::move(**all);
    return Error{ErrorCode::computation, "the sweep met more than " + std::to_string(most) + " crossings", "",
                 "take clean-up in rounds, or a smaller radius"};
  }

  /// Neighbours first, until few crossings are left.
  Result<Outline> in_rounds() {
    double left = 1;
    {
      const Paths paths = take_apart(geometry_.instance(), longest_path);
      counters_.paths = paths.count();
      if (auto error = first_round(paths, left)) return *error;
    }
    for (;;) {
      const std::size_t curves = curves_of(outlines_);
      // Rounds that take away much are worth more of them; crossings tell for certain.
      if (left > 0.7 || outlines_.size() <= fan) {
        auto all = sweep_all(outlines_.size() <= fan ? unlimited : most_per_curve * curves + 64);
        if (!all) return all.error();
        if (*all) return std::move(**all);
      }
      if (auto error = next_round()) return *error;
      left = double(curves_of(outlines_)) / double(curves);
    }
  }

 private:
  static constexpr std::uint64_t most_per_curve = 1;

  Result<std::optional<Outline>> sweep_all(std::uint64_t most) {
    ++counters_.rounds;
    Predicates predicates(geometry_);
    auto found = sweep(overlay(outlines_, predicates), most, predicates, context_);
    add(counters_, predicates.counters);
    return found;
  }

  std::optional<Error> first_round(const Paths& paths, double& left) {
    std::vector<std::size_t> raw(paths.count());
    auto error = round(paths.count(), 64, [&](std::size_t p, Predicates& predicates) {
      Outline outline = outline_of_path(paths, Index(p), predicates);
      raw[p] = outline.curves.size();
      return sweep(std::move(outline), unlimited, predicates, context_);
    });
    left = double(curves_of(outlines_)) / double(std::accumulate(raw.begin(), raw.end(), std::size_t{0}));
    return error;
  }

  std::optional<Error> next_round() {
    const std::vector<Outline> parts = std::move(outlines_);
    return round((parts.size() + fan - 1) / fan, 4, [&](std::size_t i, Predicates& predicates) {
      const std::size_t first = i * fan, last = std::min(parts.size(), first + fan);
      return sweep(overlay({parts.data() + first, last - first}, predicates), unlimited, predicates, context_);
    });
  }

  /// `unite(i, predicates)` gives outline i of the next round.
  template <class Unite>
  std::optional<Error> round(std::size_t count, std::size_t block, Unite&& unite) {
    ++counters_.rounds;
    outlines_.clear();
    outlines_.resize(count);
    struct Part {
      SweepCounters counters;
      std::optional<Error> error;
    };
    std::vector<Part> parts((count + block - 1) / block);
    Context quiet;
    quiet.threads = context_.threads;
    quiet.cancel = context_.cancel;
    kernel::parallel_blocks(quiet, count, block, [&](std::size_t first, std::size_t last) {
      Predicates predicates(geometry_);
      Part& part = parts[first / block];
      for (std::size_t i = first; i < last && !part.error; ++i) {
        auto united = unite(i, predicates);
        if (united)
          outlines_[i] = std::move(**united);
        else
          part.error = united.error();
      }
      part.counters = predicates.counters;
    });
    if (context_.cancelled()) return Error{ErrorCode::cancelled, "cancelled", "", ""};
    for (const Part& part : parts) {
      add(counters_, part.counters);
      if (part.error) return part.error;
    }
    return std::nullopt;
  }

  const Geometry& geometry_;
  const Context& context_;
  SweepCounters& counters_;
  std::vector<Outline> outlines_;
};

}  // namespace
}  // namespace sweep

Result<Zone> compute_zone_by_sweep(std::shared_ptr<const Network> network, const SweepOptions& options,
                                   const Context& context, SweepCounters* counters) {
  const auto precision = zone::precision_for(*network, options.radius);
  if (!precision) return precision.error();
  const zone::Instance instance(*network, options.radius, precision->effective_radius, precision->resolution, context);
  SweepCounters own;
  std::vector<zone::Piece> pieces;
  {
    const sweep::Geometry geometry(instance, context);
    sweep::Union cigars(geometry, context, own);
    const auto boundary =
        options.clean_up == SweepOptions::CleanUp::rounds ? cigars.in_rounds() : cigars.at_once(options.most_crossings);
    sweep::Predicates predicates(geometry);
    if (boundary) pieces = sweep::pieces_of(*boundary, predicates);
    sweep::add(own, predicates.counters);
    if (counters != nullptr) *counters = own;
    if (!boundary) return boundary.error();
  }
  auto linked = zone::link_pieces(instance, pieces, context);
  if (!linked) return linked.error();
  pieces = {};
  return ZoneAssembly::finish(std::move(network), instance, std::move(*linked), precision->resolution, {}, context);
}

}  // namespace krepl
