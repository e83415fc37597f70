#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "krepl/context.hpp"
#include "krepl/error.hpp"
#include "krepl/network.hpp"
#include "krepl/zone.hpp"

namespace krepl {

/// How a zone by sweep came about. Printed by `krepl --verbose`.
struct SweepCounters {
  std::uint64_t paths = 0;      ///< that the network was taken apart into
  std::uint64_t rounds = 0;     ///< of uniting neighbours, the last sweep included
  std::uint64_t curves = 0;     ///< stretches monotone in x that went into sweeps, in all rounds
  std::uint64_t crossings = 0;  ///< met by sweeps, in all rounds: the k of O((n + k) log n)
  std::uint64_t decisions = 0;  ///< that double precision did not dismiss at once
  std::uint64_t decided_in_quadruple = 0;
  std::uint64_t decided_in_320_bits = 0;
  std::uint64_t ties = 0;  ///< left open even by 320 bits and decided by order of names: none are known
};

struct SweepOptions {
  /// Radius of the disk in the input's unit: finite and positive.
  double radius = 0;
  /// How much is cleaned up before the sweep that finds the zone.
  enum class CleanUp : std::uint8_t {
    rounds,     ///< outlines of neighbouring segments are united until few crossings are left: any radius
    neighbours  ///< as the thesis has it, of consecutive segments only: quadratic where many cigars overlap
  };
  CleanUp clean_up = CleanUp::rounds;
  /// With CleanUp::neighbours, a sweep that meets more crossings than this is given up with ErrorCode::computation.
  std::uint64_t most_crossings = std::uint64_t{1} << 28;
};

/// The zone of a network by a plane sweep over the boundaries of cigars (thesis section 3.3, `SubRiverBufferZone`;
/// docs/sweep.md): the same zone as compute_zone gives, found without its search and its intervals, so each is the
/// other's witness. The instance and the assembly of rings are those of compute_zone.
///
/// Expected O(n log^2 n) with CleanUp::rounds, O((n + k) log n) for k crossings with CleanUp::neighbours; about 1 kB
/// per segment. `counters`, if given, receives what it cost. Errors as compute_zone.
Result<Zone> compute_zone_by_sweep(std::shared_ptr<const Network> network, const SweepOptions& options,
                                   const Context& context = {}, SweepCounters* counters = nullptr);

/// How compute_zone_auto came to its zone.
struct AutoCounters {
  bool by_sweep = false;
  std::string given_up;  ///< why the engine by intervals was given up; empty: it was not
  SweepCounters sweep;
};

/// The zone by intervals (compute_zone), or by the sweep where too many cigars come near the same places: along a finely
/// digitised circle of nearly the radius the search by intervals is quadratic, the sweep is not (docs/zone.md, "Which
/// engine"). The same zone either way. `most_candidates` of the options is chosen here if it is 0; should the sweep not
/// certify either, by intervals without a limit. Errors as compute_zone.
Result<Zone> compute_zone_auto(std::shared_ptr<const Network> network, const ZoneOptions& options,
                               const Context& context = {}, AutoCounters* counters = nullptr);

}  // namespace krepl
