/* The zone of a small river from C: every place within 50 m of it, and how long its boundary is by stream. */
#include <krepl/krepl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static double piece_length(const krepl_piece* piece, double radius) {
  double angle;
  if (piece->kind == KREPL_SEGMENT) return hypot(piece->end_x - piece->start_x, piece->end_y - piece->start_y);
  angle = atan2(piece->end_y - piece->center_y, piece->end_x - piece->center_x) -
          atan2(piece->start_y - piece->center_y, piece->start_x - piece->center_x);
  if (angle <= 0) angle += 8 * atan(1.0); /* arcs run counter-clockwise; start == end is the full circle */
  return angle * radius;
}

/* Prints the length of the boundary that each stream causes. */
static krepl_status print_lengths(krepl_context* context, const krepl_zone* zone) {
  const size_t count = krepl_zone_piece_count(zone);
  krepl_piece* pieces = malloc(count * sizeof *pieces);
  krepl_status status =
      pieces == NULL ? KREPL_ERROR_MEMORY : krepl_zone_pieces(context, zone, 0, count, pieces, sizeof *pieces);
  double length[3] = {0, 0, 0};
  size_t i;
  if (status == KREPL_OK) {
    for (i = 0; i < count; ++i) length[pieces[i].feature] += piece_length(&pieces[i], krepl_zone_radius(zone));
    printf("stream 1: %.3f, stream 2: %.3f\n", length[1], length[2]);
  }
  free(pieces);
  return status;
}

int main(void) {
  /* Two streams that meet, in metres; the numbers 1 and 2 are the caller's and come back with each piece. */
  const double main_stream[] = {0, 0, 200, 0, 400, 0};
  const double tributary[] = {200, 150, 200, 0};
  krepl_zone_options options = KREPL_ZONE_OPTIONS(50);
  krepl_context* context = krepl_context_create();
  krepl_builder* builder = krepl_builder_create();
  krepl_network* river = NULL;
  krepl_zone* zone = NULL;

  krepl_status status = krepl_builder_add_line(context, builder, main_stream, 3, 1);
  if (status == KREPL_OK) status = krepl_builder_add_line(context, builder, tributary, 2, 2);
  if (status == KREPL_OK) status = krepl_network_build(context, builder, &river);
  if (status == KREPL_OK) status = krepl_zone_compute(context, river, &options, &zone);
  if (status == KREPL_OK) {
    printf("area %.3f, boundary %.3f\n", krepl_zone_area(zone), krepl_zone_perimeter(zone));
    status = print_lengths(context, zone);
  }
  if (status != KREPL_OK) fprintf(stderr, "%s: %s\n", krepl_status_text(status), krepl_context_message(context));

  krepl_zone_destroy(zone);
  krepl_network_destroy(river);
  krepl_builder_destroy(builder);
  krepl_context_destroy(context);
  return status == KREPL_OK ? 0 : 1;
}
