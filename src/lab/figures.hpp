#pragma once

#include "lab/construction.hpp"

namespace krepl::lab {

/// Figure 4.5: two long thin triangles t_j and t_k above a third one, t_i, one along x and one along y, disjoint in
/// space. On the plane over t_i the curves d(k_i) and d(k_j), d(k_i) and d(k_k) cut out are two long ovals across each
/// other: they cross four times, where boundaries of pseudospheres would cross twice at most. R = 1.
Construction crossing_needles();

/// The same of three triangles with disjoint projections, so of a terrain: t_j and t_k stand beside an edge of t_i, one
/// behind the other. Where on t_i the ball is stopped by t_j is a bump along the edge, and so it is for t_k: t_j, of
/// which the top edges fall from the middle to both ends, stops it first in the middle and beyond the ends of t_k, t_k
/// in between. Four balls touch all three. R = 1.
Construction crossing_blades();

/// The counter-example to theorem 4.5.4: 22 triangles, of which the last one, (0,0,0), (1,10,0), (-1,10,0), added to
/// all others meets their sum's boundary in two components, a closed curve and an arc. R = 1.
Construction two_components();

}  // namespace krepl::lab
