/* device_none.cpp without a second process: the same motion of one tool, answered by libhapsim.so
 * in the device's own thread within microseconds. usage: device_linked X Y Z body.ply m.csv RADIUS
 *   X Y Z [m]: a point of the surface seen from above; RADIUS of the tool: 0.004 or 4mm. The forces
 * are for a hand: within the limits of hs-safety(7), by the device's clock. A program that hangs
 * itself must be caught by the device; where the loop must be watched by another process, see
 * device_none.cpp. */
#include <hapsim.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static void tell(void* context, const char* words) {
  (void)context;
  fprintf(stderr, "%s\n", words);
}

int main(int argc, char** argv) {
  if (argc != 7) {
    fprintf(stderr, "usage: %s X Y Z body.ply m.csv RADIUS\n", argv[0]);
    return HS_USAGE;
  }
  const double x = atof(argv[1]), y = atof(argv[2]), z = atof(argv[3]);
  hs_body* body = NULL;
  hs_model* model = NULL;
  hs_options *options = NULL, *hand = NULL;
  hs_prepared* ready = NULL;
  hs_live* tool = NULL;
  hs_status status = hs_body_read(argv[4], &body);
  if (status == HS_DONE) status = hs_model_read(argv[5], &model);
  if (status == HS_DONE) status = hs_options_new(&options);
  if (status == HS_DONE) hs_options_listen(options, tell, NULL, NULL);
  if (status == HS_DONE) status = hs_options_set(options, "tool-radius", argv[6]);
  if (status == HS_DONE)
    status = hs_prepare(body, model, NULL, options, &ready); /* some 20 s the first time */
  if (status == HS_DONE) status = hs_options_new(&hand);
  if (status == HS_DONE) status = hs_options_set(hand, "hand", "true");
  if (status == HS_DONE) status = hs_live_new(ready, hand, &tool);
  if (status == HS_DONE) {
    double largest = 0;
    long limited = 0;
    for (int i = 0; i < 2000; ++i) {
      const double t = 1e-3 * i, dip = sin(3 * t);
      const double tip[3] = {x + 1e-3 * sin(5 * t), y + 1e-3 * cos(5 * t),
                             z + 1e-3 - 3e-3 * dip * dip};
      double force[3];
      hs_feel feel;
      hs_live_step(tool, t, tip, force); /* what the device is given */
      hs_live_feel(tool, &feel);
      if (feel.safety != 0) ++limited;
      if (force[2] > largest) largest = force[2];
    }
    hs_live_end(tool);
    printf("largest force along z %.4g N, %ld limited\n", largest, limited);
  } else {
    fprintf(stderr, "%s\n", hs_message());
  }
  hs_live_free(tool);
  hs_prepared_free(ready);
  hs_options_free(hand);
  hs_options_free(options);
  hs_model_free(model);
  hs_body_free(body);
  return status;
}
