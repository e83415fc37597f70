/* krepl.h as a C program uses it: results that were worked out by hand, every way to fail, cancelling, lifetimes. */
#include <krepl/krepl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int failures = 0;

#define CHECK(condition)                                                      \
  do {                                                                        \
    if (!(condition)) {                                                       \
      fprintf(stderr, "%s:%d: not so: %s\n", __FILE__, __LINE__, #condition); \
      ++failures;                                                             \
    }                                                                         \
  } while (0)

static const double pi = 3.14159265358979323846;

static int near_to(double value, double expected) { return fabs(value - expected) <= 1e-12 * fabs(expected); }

static int says(const krepl_context* context, const char* words) {
  if (strstr(krepl_context_message(context), words) != NULL) return 1;
  fprintf(stderr, "message \"%s\" does not say \"%s\"\n", krepl_context_message(context), words);
  return 0;
}

/* Two streams that meet, features 10 and 20, and a lone point, feature 30. */
static krepl_network* streams(krepl_context* context) {
  static const double stream[] = {0, 0, 200, 0, 400, 0};
  static const double tributary[] = {200, 150, 200, 0};
  krepl_builder* builder = krepl_builder_create();
  krepl_network* network = NULL;
  CHECK(krepl_builder_add_line(context, builder, stream, 3, 10) == KREPL_OK);
  CHECK(krepl_builder_add_line(context, builder, tributary, 2, 20) == KREPL_OK);
  CHECK(krepl_builder_add_point(context, builder, 1000, 0, 30) == KREPL_OK);
  CHECK(krepl_network_build(context, builder, &network) == KREPL_OK);
  krepl_builder_destroy(builder);
  return network;
}

/* Distance from a point to the nearest of the streams and the point, by hand. */
static double distance(double x, double y) {
  const double along = x < 0 ? 0 : x > 400 ? 400 : x, up = y < 0 ? 0 : y > 150 ? 150 : y;
  const double stream = hypot(x - along, y), tributary = hypot(x - 200, y - up), point = hypot(x - 1000, y);
  return fmin(fmin(stream, tributary), point);
}

static void check_piece(const krepl_piece* piece, double radius) {
  CHECK(fabs(distance(piece->start_x, piece->start_y) - radius) < 1e-9);
  CHECK(piece->feature == 10 || piece->feature == 20 || piece->feature == 30);
  CHECK(piece->part == (uint32_t)(piece->feature / 10 - 1));
  if (piece->kind == KREPL_ARC) {
    CHECK(piece->radius == radius && piece->clockwise == 0);
    CHECK(fabs(hypot(piece->end_x - piece->center_x, piece->end_y - piece->center_y) - radius) < 1e-9);
    CHECK(distance(piece->center_x, piece->center_y) < 1e-9);
  } else {
    CHECK(piece->kind == KREPL_SEGMENT && isnan(piece->center_x));
    CHECK(fabs(distance((piece->start_x + piece->end_x) / 2, (piece->start_y + piece->end_y) / 2) - radius) < 1e-9);
  }
}

static void check_rings(krepl_context* context, const krepl_zone* zone) {
  const size_t pieces = krepl_zone_piece_count(zone), rings = krepl_zone_ring_count(zone);
  krepl_piece* piece = (krepl_piece*)calloc(pieces, sizeof *piece);
  krepl_ring* ring = (krepl_ring*)calloc(rings, sizeof *ring);
  size_t r, e, next = 0;
  CHECK(krepl_zone_pieces(context, zone, 0, pieces, piece, sizeof *piece) == KREPL_OK);
  CHECK(krepl_zone_rings(context, zone, 0, rings, ring, sizeof *ring) == KREPL_OK);
  for (r = 0; r < rings; ++r) {
    CHECK(ring[r].first_piece == next && ring[r].polygon < krepl_zone_polygon_count(zone) && ring[r].is_hole == 0);
    next += ring[r].piece_count;
    for (e = ring[r].first_piece; e < next; ++e) {
      const krepl_piece* after = &piece[e + 1 < next ? e + 1 : ring[r].first_piece];
      CHECK(piece[e].end_x == after->start_x && piece[e].end_y == after->start_y);
      check_piece(&piece[e], krepl_zone_radius(zone));
    }
  }
  CHECK(next == pieces);
  free(piece);
  free(ring);
}

static void test_zone(krepl_context* context, int32_t engine) {
  krepl_network* network = streams(context);
  krepl_zone_options options = KREPL_ZONE_OPTIONS(50);
  krepl_zone* zone = NULL;
  options.engine = engine;
  CHECK(krepl_network_vertex_count(network) == 5 && krepl_network_segment_count(network) == 3);
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_OK);
  krepl_network_destroy(network); /* the zone does without it */
  CHECK(krepl_zone_radius(zone) == 50);
  CHECK(near_to(krepl_zone_area(zone), 50000 + 2.5 * pi * 2500));
  CHECK(near_to(krepl_zone_perimeter(zone), 900 + 5 * pi * 50));
  CHECK(krepl_zone_polygon_count(zone) == 2 && krepl_zone_ring_count(zone) == 2 && krepl_zone_hole_count(zone) == 0);
  CHECK(krepl_zone_check(context, zone) == KREPL_OK);
  check_rings(context, zone);
  krepl_zone_destroy(zone);
}

/* A square frame: a hole for the small radius, none for the large one; nested radii in one call. */
static void test_many_radii(krepl_context* context) {
  static const double outer[] = {0, 0, 10, 0, 10, 10, 0, 10}, inner[] = {2, 2, 8, 2, 8, 8, 2, 8};
  enum { count = 20 };
  krepl_zone_options options = KREPL_ZONE_OPTIONS(0);
  krepl_zone* zones[count];
  krepl_network* network = NULL;
  krepl_builder* builder = krepl_builder_create();
  double radii[count];
  int i;
  CHECK(krepl_builder_add_ring(context, builder, outer, 4, 1) == KREPL_OK);
  CHECK(krepl_builder_add_ring(context, builder, inner, 4, 1) == KREPL_OK);
  CHECK(krepl_network_build(context, builder, &network) == KREPL_OK);
  krepl_builder_destroy(builder);
  for (i = 0; i < count; ++i) radii[i] = 0.2 * (i + 1);
  CHECK(krepl_zone_compute_all(context, network, &options, radii, count, zones) == KREPL_OK);
  for (i = 0; i < count; ++i) {
    const double r = radii[i], hole = 6 - 2 * r;
    const int has_hole = i < 14;
    CHECK(krepl_zone_hole_count(zones[i]) == (size_t)has_hole);
    CHECK(near_to(krepl_zone_area(zones[i]), 100 + 40 * r + pi * r * r - (has_hole ? hole * hole : 0)));
    krepl_zone_destroy(zones[i]);
  }
  CHECK(krepl_zone_compute_all(context, network, &options, radii, 0, zones) == KREPL_OK);
  krepl_network_destroy(network);
}

static void test_profile(krepl_context* context) {
  static const double ground[] = {0, 0, 4, 3, 8, 3};
  static const double falling[] = {0, 0, 4, 3, 3, 3};
  krepl_profile* profile = NULL;
  krepl_profile_piece piece[7];
  size_t count;
  CHECK(krepl_profile_compute(context, ground, 3, 1, &profile) == KREPL_OK);
  count = krepl_profile_piece_count(profile);
  CHECK(count == 7 && krepl_profile_radius(profile) == 1 && krepl_profile_explicit_vertex_count(profile) == 0);
  CHECK(krepl_profile_pieces(context, profile, 0, count, piece, sizeof *piece) == KREPL_OK);
  CHECK(piece[0].kind == KREPL_HALF_LINE && piece[0].start_z == -HUGE_VAL && piece[0].start_x == -1);
  CHECK(piece[2].kind == KREPL_SEGMENT && piece[2].index == 0 && near_to(piece[2].start_x, -0.6) &&
        near_to(piece[2].start_z, 0.8));
  CHECK(piece[3].kind == KREPL_ARC && piece[3].index == 1 && piece[3].center_x == 4 && piece[3].center_z == 3);
  CHECK(piece[6].kind == KREPL_HALF_LINE && piece[6].end_x == 9);
  krepl_profile_destroy(profile);

  CHECK(krepl_profile_compute(context, falling, 3, 1, &profile) == KREPL_ERROR_INPUT && profile == NULL);
  CHECK(says(context, "2"));
  CHECK(krepl_profile_compute(context, ground, 3, -1, &profile) == KREPL_ERROR_USAGE && profile == NULL);
  CHECK(krepl_profile_compute(context, NULL, 0, 1, &profile) == KREPL_ERROR_INPUT);
  CHECK(krepl_profile_compute(context, NULL, 3, 1, &profile) == KREPL_ERROR_USAGE);
  CHECK(krepl_profile_compute(context, ground, 3, 1, NULL) == KREPL_ERROR_USAGE);
}

static void test_bad_radii(krepl_context* context, const krepl_network* network) {
  static const double bad[] = {0, -1, 1e-30, HUGE_VAL};
  krepl_zone_options options = KREPL_ZONE_OPTIONS(0);
  krepl_zone* zone = (krepl_zone*)&failures;
  size_t i;
  for (i = 0; i < 4; ++i) {
    options.radius = bad[i];
    CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_USAGE && zone == NULL);
    CHECK(says(context, "radius"));
  }
  options.radius = HUGE_VAL - HUGE_VAL;
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_USAGE && zone == NULL);
}

/* What a program compiled with another version of the header hands over. */
static void test_options(krepl_context* context, const krepl_network* network) {
  struct later {
    krepl_zone_options known;
    int32_t unknown[4];
  } later;
  krepl_zone_options options = KREPL_ZONE_OPTIONS(1);
  krepl_zone* zone = NULL;
  memset(&later, 0, sizeof later);
  later.known.size = sizeof later;
  later.known.radius = 2;
  CHECK(krepl_zone_compute(context, network, &later.known, &zone) == KREPL_OK && krepl_zone_radius(zone) == 2);
  krepl_zone_destroy(zone);
  later.unknown[1] = 1;
  CHECK(krepl_zone_compute(context, network, &later.known, &zone) == KREPL_ERROR_USAGE && zone == NULL);
  CHECK(says(context, "does not know"));
  options.engine = 77;
  options.size = offsetof(krepl_zone_options, engine); /* older: has no engine */
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_OK && krepl_zone_radius(zone) == 1);
  krepl_zone_destroy(zone);
  options.size = sizeof options;
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_USAGE && says(context, "engine"));
  options.size = 0;
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_USAGE && says(context, "size"));
}

static void test_null(krepl_context* context, const krepl_network* network) {
  krepl_zone_options options = KREPL_ZONE_OPTIONS(1);
  krepl_builder* builder = krepl_builder_create();
  krepl_network* built = NULL;
  krepl_zone* zone = NULL;
  krepl_piece piece;
  krepl_ring ring;
  CHECK(krepl_zone_compute(context, NULL, &options, &zone) == KREPL_ERROR_USAGE && says(context, "network is NULL"));
  CHECK(krepl_zone_compute(context, network, NULL, &zone) == KREPL_ERROR_USAGE && says(context, "options are NULL"));
  CHECK(krepl_zone_compute(context, network, &options, NULL) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_compute_all(context, network, &options, NULL, 1, &zone) == KREPL_ERROR_USAGE && zone == NULL);
  CHECK(krepl_zone_compute(NULL, NULL, NULL, &zone) == KREPL_ERROR_USAGE);
  CHECK(krepl_builder_add_line(context, NULL, NULL, 0, 1) == KREPL_ERROR_USAGE);
  CHECK(krepl_builder_add_line(context, builder, NULL, 1, 1) == KREPL_ERROR_USAGE);
  CHECK(krepl_network_build(context, NULL, &built) == KREPL_ERROR_USAGE);
  CHECK(krepl_network_build(context, builder, NULL) == KREPL_ERROR_USAGE);
  CHECK(krepl_network_build(context, builder, &built) == KREPL_ERROR_INPUT && built == NULL);
  CHECK(krepl_zone_pieces(context, NULL, 0, 1, &piece, sizeof piece) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_rings(context, NULL, 0, 1, &ring, sizeof ring) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_check(context, NULL) == KREPL_ERROR_USAGE);
  CHECK(krepl_profile_pieces(context, NULL, 0, 1, NULL, 1) == KREPL_ERROR_USAGE);
  CHECK(isnan(krepl_zone_area(NULL)) && isnan(krepl_zone_perimeter(NULL)) && isnan(krepl_zone_radius(NULL)));
  CHECK(isnan(krepl_profile_radius(NULL)) && krepl_profile_piece_count(NULL) == 0);
  CHECK(krepl_zone_piece_count(NULL) + krepl_zone_ring_count(NULL) + krepl_zone_hole_count(NULL) == 0);
  CHECK(krepl_zone_polygon_count(NULL) + krepl_network_vertex_count(NULL) + krepl_network_segment_count(NULL) == 0);
  CHECK(krepl_profile_explicit_vertex_count(NULL) == 0 && strcmp(krepl_context_message(NULL), "") == 0);
  CHECK(krepl_context_set_threads(NULL, 1) == KREPL_ERROR_USAGE);
  CHECK(krepl_context_set_progress(NULL, NULL, NULL) == KREPL_ERROR_USAGE);
  krepl_context_cancel(NULL);
  krepl_context_resume(NULL);
  krepl_context_destroy(NULL);
  krepl_zone_destroy(NULL);
  krepl_profile_destroy(NULL);
  krepl_network_destroy(NULL);
  krepl_builder_destroy(builder);
  krepl_builder_destroy(NULL);
}

/* Ranges, and elements of another size than the library's. */
static void test_copying(krepl_context* context, const krepl_network* network) {
  struct later {
    krepl_piece known;
    double unknown;
  } later[2];
  krepl_zone_options options = KREPL_ZONE_OPTIONS(50);
  krepl_zone* zone = NULL;
  krepl_piece piece[2];
  double start[4];
  size_t pieces;
  CHECK(krepl_zone_compute(NULL, network, &options, &zone) == KREPL_OK); /* without a context */
  pieces = krepl_zone_piece_count(zone);
  CHECK(krepl_zone_pieces(context, zone, pieces, 1, piece, sizeof *piece) == KREPL_ERROR_USAGE &&
        says(context, "last"));
  CHECK(krepl_zone_pieces(context, zone, 1, (size_t)-1, piece, sizeof *piece) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_pieces(context, zone, 0, 1, NULL, sizeof *piece) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_pieces(context, zone, 0, 1, piece, 0) == KREPL_ERROR_USAGE);
  CHECK(krepl_zone_pieces(context, zone, pieces, 0, NULL, sizeof *piece) == KREPL_OK);
  CHECK(krepl_zone_pieces(context, zone, 1, 2, piece, sizeof *piece) == KREPL_OK);
  CHECK(krepl_zone_pieces(context, zone, 1, 2, (krepl_piece*)start, 2 * sizeof *start) == KREPL_OK);
  CHECK(start[0] == piece[0].start_x && start[1] == piece[0].start_y && start[2] == piece[1].start_x);
  later[0].unknown = later[1].unknown = 7;
  CHECK(krepl_zone_pieces(context, zone, 1, 2, &later[0].known, sizeof *later) == KREPL_OK);
  CHECK(later[1].known.start_x == piece[1].start_x && later[1].known.kind == piece[1].kind && later[0].unknown == 7);
  krepl_zone_destroy(zone);
}

static void test_bad_coordinates(krepl_context* context) {
  const double line[] = {0, 0, 1, HUGE_VAL}, good[] = {0, 0, 1, 1};
  krepl_builder* builder = krepl_builder_create();
  krepl_network* network = NULL;
  CHECK(krepl_builder_add_line(context, builder, line, 2, 42) == KREPL_OK);
  CHECK(krepl_network_build(context, builder, &network) == KREPL_ERROR_INPUT && network == NULL);
  CHECK(says(context, "42"));
  CHECK(krepl_builder_add_line(context, builder, good, 2, 1) == KREPL_OK); /* the builder is empty and goes on */
  CHECK(krepl_network_build(context, builder, &network) == KREPL_OK && krepl_network_vertex_count(network) == 2);
  krepl_network_destroy(network);
  krepl_builder_destroy(builder);
}

static int32_t count_and_stop(double fraction, void* user) {
  int* calls = (int*)user;
  CHECK(fraction >= 0 && fraction <= 1);
  ++*calls;
  return *calls == 2;
}

/* A long zigzag, so that there is something to interrupt. */
static krepl_network* zigzag(krepl_context* context) {
  enum { count = 60000 };
  double* xy = (double*)malloc(2 * count * sizeof *xy);
  krepl_builder* builder = krepl_builder_create();
  krepl_network* network = NULL;
  int i;
  for (i = 0; i < count; ++i) {
    xy[2 * i] = i;
    xy[2 * i + 1] = i % 2 == 0 ? 0 : 3;
  }
  CHECK(krepl_builder_add_line(context, builder, xy, count, 1) == KREPL_OK);
  free(xy);
  CHECK(krepl_network_build(context, builder, &network) == KREPL_OK);
  krepl_builder_destroy(builder);
  return network;
}

static void test_cancelling(krepl_context* context) {
  krepl_network* network = zigzag(context);
  krepl_zone_options options = KREPL_ZONE_OPTIONS(1);
  krepl_zone* zone = NULL;
  int calls = 0;
  CHECK(krepl_context_set_threads(context, 1) == KREPL_OK);
  CHECK(krepl_context_set_progress(context, count_and_stop, &calls) == KREPL_OK);
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_CANCELLED && zone == NULL && calls >= 2);
  CHECK(says(context, "cancelled"));
  calls = 2; /* it counts on from here and stops no more; nor does the last stop have an effect */
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_OK && calls > 2);
  krepl_zone_destroy(zone);
  CHECK(krepl_context_set_progress(context, NULL, NULL) == KREPL_OK);
  krepl_context_cancel(context);
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_CANCELLED && zone == NULL);
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_ERROR_CANCELLED && zone == NULL);
  krepl_context_resume(context);
  CHECK(krepl_zone_compute(context, network, &options, &zone) == KREPL_OK);
  krepl_zone_destroy(zone);
  CHECK(krepl_context_set_threads(context, 0) == KREPL_OK);
  krepl_network_destroy(network);
}

static void test_versions(void) {
  char header[32];
  sprintf(header, "%d.%d.%d", KREPL_VERSION_MAJOR, KREPL_VERSION_MINOR, KREPL_VERSION_PATCH);
  CHECK(strcmp(krepl_version(), header) == 0);
#ifdef PROJECT_VERSION
  CHECK(strcmp(krepl_version(), PROJECT_VERSION) == 0);
#endif
  CHECK(krepl_interface_version() == KREPL_INTERFACE_VERSION);
  CHECK(strcmp(krepl_status_text(KREPL_OK), krepl_status_text(KREPL_ERROR_INPUT)) != 0 &&
        krepl_status_text(-5) != NULL);
}

int main(void) {
  krepl_context* context = krepl_context_create();
  krepl_network* network;
  CHECK(strcmp(krepl_context_message(context), "") == 0);
  test_versions();
  test_zone(context, KREPL_ENGINE_AUTO);
  test_zone(context, KREPL_ENGINE_INTERVALS);
  test_zone(context, KREPL_ENGINE_VORONOI);
  test_many_radii(context);
  test_profile(context);
  network = streams(context);
  test_bad_radii(context, network);
  test_options(context, network);
  test_null(context, network);
  test_copying(context, network);
  krepl_network_destroy(network);
  test_bad_coordinates(context);
  test_cancelling(context);
  krepl_context_destroy(context);
  if (failures == 0) printf("passed\n");
  return failures == 0 ? 0 : 1;
}
