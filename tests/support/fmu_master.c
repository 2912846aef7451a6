/* fmu_master LIBRARY GUID RESOURCES MOTION OTHER: an importer of FMI 2.0 that does what a
 * simulation does and what it must not. MOTION has rows t x y z. Writes
 * t,fx,fy,fz,uncertainty,beyond,press,contact of each row to standard output, and says on standard
 * error what was wrong; exit code 1 then. OTHER: a folder with the same files. */
#include <dlfcn.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fmi2_declarations.h"

static int wrong, told;
static char last[4000];

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status,
                   fmi2String category, fmi2String message, ...) {
  va_list words;
  va_start(words, message);
  vsnprintf(last, sizeof last, message, words);
  va_end(words);
  if (status == fmi2Error) ++told;
  if (environment != &told || strcmp(instance, "tool") != 0 || !category) {
    fprintf(stderr, "the logger has other arguments\n");
    wrong = 1;
  }
}

#define CHECK(condition)                                                                   \
  do {                                                                                     \
    if (!(condition)) {                                                                    \
      fprintf(stderr, "line %d: not so: %s; last said: %s\n", __LINE__, #condition, last); \
      wrong = 1;                                                                           \
    }                                                                                      \
  } while (0)
/* Refused, and said why in words that hold `text`. */
#define REFUSED(call, text)                          \
  do {                                               \
    const int before = told;                         \
    last[0] = 0;                                     \
    CHECK((call) == fmi2Error);                      \
    CHECK(told == before + 1 && strstr(last, text)); \
  } while (0)

/* clang-format off */
#define FUNCTIONS(X)                                                                             \
  X(GetTypesPlatform) X(GetVersion) X(Instantiate) X(FreeInstance) X(SetDebugLogging)            \
  X(SetupExperiment) X(EnterInitializationMode) X(ExitInitializationMode) X(Terminate) X(Reset)  \
  X(GetReal) X(GetInteger) X(GetBoolean) X(GetString)                                            \
  X(SetReal) X(SetInteger) X(SetBoolean) X(SetString)                                            \
  X(GetFMUstate) X(SetFMUstate) X(FreeFMUstate)                                                  \
  X(SerializedFMUstateSize) X(SerializeFMUstate) X(DeSerializeFMUstate)                          \
  X(GetDirectionalDerivative) X(SetRealInputDerivatives) X(GetRealOutputDerivatives)             \
  X(DoStep) X(CancelStep)                                                                        \
  X(GetStatus) X(GetRealStatus) X(GetIntegerStatus) X(GetBooleanStatus) X(GetStringStatus)
/* clang-format on */
#define DECLARE(name) static __typeof__(&fmi2##name) name##_;
FUNCTIONS(DECLARE)

static const fmi2ValueReference kTip[] = {0, 1, 2}, kOut[] = {3, 4, 5, 6}, kInt[] = {0, 1},
                                kFirst[] = {0}, kRadius[] = {7}, kNone[] = {99};

typedef struct {
  double t, tip[3];
} Row;

static void row_out(fmi2Component c, double t) {
  double f[4];
  int whole[2], contact[1];
  CHECK(GetReal_(c, kOut, 4, f) == fmi2OK);
  CHECK(GetInteger_(c, kInt, 2, whole) == fmi2OK);
  CHECK(GetBoolean_(c, kFirst, 1, contact) == fmi2OK);
  printf("%.17g,%.17g,%.17g,%.17g,%.17g,%d,%d,%d\n", t, f[0], f[1], f[2], f[3], whole[0], whole[1],
         contact[0]);
}

/* Instantiated to the end of the motion; `early` asks for outputs while it is initialised. */
static void simulate(fmi2Component c, const Row* rows, size_t count, int early, int out) {
  CHECK(SetupExperiment_(c, fmi2False, 0, rows[0].t, fmi2True, rows[count - 1].t) == fmi2OK);
  CHECK(EnterInitializationMode_(c) == fmi2OK);
  if (early) {
    static const double kDeep[] = {0.03, 0.025, 0.038};
    double f[4];
    CHECK(SetReal_(c, kTip, 3, kDeep) == fmi2OK);
    CHECK(GetReal_(c, kOut, 4, f) == fmi2OK); /* then another tip: of it, as if this had not been */
  }
  CHECK(SetReal_(c, kTip, 3, rows[0].tip) == fmi2OK);
  CHECK(ExitInitializationMode_(c) == fmi2OK);
  if (out) row_out(c, rows[0].t);
  double t = rows[0].t;
  for (size_t i = 1; i < count; ++i) {
    CHECK(SetReal_(c, kTip, 3, rows[i].tip) == fmi2OK);
    CHECK(DoStep_(c, t, rows[i].t - t, fmi2True) == fmi2OK);
    t += rows[i].t - t;
    if (out) row_out(c, rows[i].t);
  }
}

int main(int argc, char** argv) {
  if (argc != 6) return 2;
  void* library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
  if (!library) return fprintf(stderr, "%s\n", dlerror()), 1;
#define FIND(name)                                          \
  if (!(*(void**)& name##_ = dlsym(library, "fmi2" #name))) \
    return fprintf(stderr, "no fmi2" #name "\n"), 1;
  FUNCTIONS(FIND)
  static Row rows[10000];
  size_t count = 0;
  FILE* motion = fopen(argv[4], "r");
  while (motion && count < 10000 &&
         fscanf(motion, "%lf %lf %lf %lf", &rows[count].t, rows[count].tip, rows[count].tip + 1,
                rows[count].tip + 2) == 4)
    ++count;
  if (count < 10) return fprintf(stderr, "no motion\n"), 1;
  const fmi2CallbackFunctions callbacks = {logger, calloc, free, NULL, &told};

  CHECK(strcmp(GetTypesPlatform_(), "default") == 0 && strcmp(GetVersion_(), "2.0") == 0);
  CHECK(!Instantiate_("tool", fmi2CoSimulation, "{another}", argv[3], &callbacks, 0, 0) &&
        strstr(last, "guid"));
  CHECK(!Instantiate_("tool", fmi2ModelExchange, argv[2], argv[3], &callbacks, 0, 0) &&
        strstr(last, "co-simulation"));
  CHECK(!Instantiate_("", fmi2CoSimulation, argv[2], argv[3], &callbacks, 0, 0));
  CHECK(!Instantiate_("tool", fmi2CoSimulation, argv[2], argv[3], NULL, 0, 0));
  fmi2Component c =
      Instantiate_("tool", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2True);
  if (!c) return fprintf(stderr, "not instantiated: %s\n", last), 1;

  /* Before it is initialised. */
  double value[4] = {0, 0, 0, 0};
  REFUSED(DoStep_(c, 0, 0.1, fmi2True), "not before fmi2EnterInitializationMode");
  REFUSED(ExitInitializationMode_(c), "fmi2ExitInitializationMode: not before");
  REFUSED(EnterInitializationMode_(c), "not before fmi2SetupExperiment");
  REFUSED(GetReal_(c, kOut, 4, value), "fmi2GetReal: not before");
  REFUSED(Terminate_(c), "fmi2Terminate: not before");
  REFUSED(SetupExperiment_(c, fmi2False, 0, 1, fmi2True, 0), "no interval");
  CHECK(DoStep_(NULL, 0, 0.1, fmi2True) == fmi2Error && Reset_(NULL) == fmi2Error);
  FreeInstance_(NULL);

  simulate(c, rows, count, 0, 1);

  /* While steps are made. */
  const double end = rows[count - 1].t;
  REFUSED(DoStep_(c, end, 0.1, fmi2True), "after the stop time");
  REFUSED(DoStep_(c, end + 1, 0.1, fmi2True), "where the last step ended");
  REFUSED(DoStep_(c, end, 0, fmi2True), "not above 0");
  REFUSED(SetupExperiment_(c, fmi2False, 0, 0, fmi2False, 0), "fmi2SetupExperiment: not while");
  REFUSED(EnterInitializationMode_(c), "not while");
  REFUSED(SetReal_(c, kOut, 1, value), "an output is not set");
  REFUSED(SetReal_(c, kNone, 1, value), "no variable");
  REFUSED(GetReal_(c, kNone, 1, value), "no variable");
  REFUSED(SetReal_(c, kRadius, 1, value), "a parameter is fixed");
  value[0] = 0.0 / 0.0;
  REFUSED(SetReal_(c, kTip, 1, value), "not finite");
  static const double kFar[] = {1e155, -10.1};
  for (size_t k = 0; k < 3; ++k)
    for (size_t i = 0; i < 2; ++i)
      REFUSED(SetReal_(c, kTip + k, 1, kFar + i),
              "a position beyond 10 m; are these millimetres? divide lengths by 1000");
  int whole[] = {1};
  REFUSED(SetInteger_(c, kInt, 1, whole), "no variable of this type");
  REFUSED(SetBoolean_(c, kInt, 1, whole), "no variable of this type");
  const char* folder = argv[5];
  REFUSED(SetString_(c, kFirst, 1, &folder), "fmi2SetString: not while");
  fmi2FMUstate state = NULL;
  REFUSED(GetFMUstate_(c, &state), "cannot");
  REFUSED(CancelStep_(c), "done when");
  double time = -1;
  CHECK(GetRealStatus_(c, fmi2LastSuccessfulTime, &time) == fmi2OK && time == end);
  fmi2Boolean ended = 1;
  CHECK(GetBooleanStatus_(c, fmi2Terminated, &ended) == fmi2OK && !ended);
  fmi2Status pending;
  CHECK(GetStatus_(c, fmi2DoStepStatus, &pending) == fmi2Discard);
  /* What was refused has changed nothing. */
  double before[4], after[4];
  CHECK(GetReal_(c, kOut, 4, before) == fmi2OK);
  CHECK(Terminate_(c) == fmi2OK);
  REFUSED(DoStep_(c, end, 0.1, fmi2True), "not after fmi2Terminate");
  REFUSED(SetReal_(c, kTip, 3, rows[0].tip), "not after fmi2Terminate");
  CHECK(GetReal_(c, kOut, 4, after) == fmi2OK && memcmp(before, after, sizeof after) == 0);

  /* The same again after a reset, with outputs asked for while it is initialised, from another
   * folder. */
  CHECK(Reset_(c) == fmi2OK);
  CHECK(SetString_(c, kFirst, 1, &folder) == fmi2OK);
  simulate(c, rows, count, 1, 0);
  CHECK(GetReal_(c, kOut, 4, after) == fmi2OK && memcmp(before, after, sizeof after) == 0);
  CHECK(Reset_(c) == fmi2OK); /* without fmi2Terminate */

  /* A folder without files: said, and mended by another one. */
  folder = "/nowhere";
  CHECK(SetString_(c, kFirst, 1, &folder) == fmi2OK);
  CHECK(SetupExperiment_(c, fmi2False, 0, 0, fmi2False, 0) == fmi2OK &&
        EnterInitializationMode_(c) == fmi2OK);
  REFUSED(ExitInitializationMode_(c), "/nowhere/body.ply");
  folder = "";
  CHECK(SetString_(c, kFirst, 1, &folder) == fmi2OK && ExitInitializationMode_(c) == fmi2OK);

  /* Two instances at once do not feel each other. */
  fmi2Component other =
      Instantiate_("tool", fmi2CoSimulation, argv[2], argv[3], &callbacks, fmi2False, fmi2False);
  CHECK(other != NULL);
  simulate(other, rows, count, 0, 0);
  CHECK(GetReal_(other, kOut, 4, after) == fmi2OK && memcmp(before, after, sizeof after) == 0);
  FreeInstance_(other);
  FreeInstance_(c);
  /* Without resources the parameter is asked for. */
  c = Instantiate_("tool", fmi2CoSimulation, argv[2], NULL, &callbacks, fmi2False, fmi2False);
  CHECK(c && SetupExperiment_(c, fmi2False, 0, 0, fmi2False, 0) == fmi2OK &&
        EnterInitializationMode_(c) == fmi2OK);
  REFUSED(ExitInitializationMode_(c), "no folder of resources; set the parameter model_directory");
  FreeInstance_(c);
  /* URIs of other things, and those with a % that begins no escape. */
  static const char* const kUri[][2] = {
      {"/nowhere", "is no file:///FOLDER of this machine"},
      {"file://host/nowhere", "is no file:///FOLDER of this machine"},
      {"file:///nowhere%00/x", "is no file:///FOLDER of this machine"},
      {"file:///nowhere%4/x%20y%", "/nowhere%4/x y%/body.ply"},
      {"file:/nowhere% 1/%2F%2f", "/nowhere% 1////body.ply"},
      {"file://localhost/nowhere", "/nowhere/body.ply"}};
  for (size_t i = 0; i < sizeof kUri / sizeof *kUri; ++i) {
    c = Instantiate_("tool", fmi2CoSimulation, argv[2], kUri[i][0], &callbacks, fmi2False,
                     fmi2False);
    CHECK(c && SetupExperiment_(c, fmi2False, 0, 0, fmi2False, 0) == fmi2OK &&
          EnterInitializationMode_(c) == fmi2OK);
    REFUSED(ExitInitializationMode_(c), kUri[i][1]);
    FreeInstance_(c);
  }
  dlclose(library);
  return wrong;
}
