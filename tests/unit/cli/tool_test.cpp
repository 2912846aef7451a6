// The sample tool as users meet it: exit codes, messages to the letter, nothing half-written.
#include "cli/tool.h"

#include <gtest/gtest.h>

#include "support/needs.h"
#include "unit/cli/run_command.h"

namespace hapsim {
namespace {

class Tool : public testing::Test {
 protected:
  void expect(const std::string& command, int code, const std::string& out,
              const std::string& err) {
    const Outcome outcome = work_.run(command);
    EXPECT_EQ(outcome.code, code) << command;
    EXPECT_EQ(outcome.out, out) << command;
    EXPECT_EQ(outcome.err, err) << command;
  }
  Workplace work_;
};

TEST_F(Tool, CopiesByEveryWay) {
  std::ofstream(work_.path("a")) << "text";
  expect("$S a", 0, "text", "");
  expect("$S <a", 0, "text", "");
  expect("$S - <a", 0, "text", "");
  expect("$S a -o -", 0, "text", "");
  expect("cat a | $S | $S -o b && cat b", 0, "text", "");
  expect("$S a -o a && cat a", 0, "text", "");
}

TEST_F(Tool, ParsesFlags) {
  expect("$S --echo", 0, "input=- output=- unit=m threads=1 given=0\n", "");
  expect("$S x.csv --echo --unit=mm --threads 3 --ratio -0.5 --effects a,b --effects c", 0,
         "input=x.csv output=- unit=mm threads=3 ratio=-0.5 effect=a effect=b effect=c given=1\n",
         "");
  expect("$S --echo -qo r -- -x && cat r", 0, "input=-x output=r unit=m threads=1 given=0\n", "");
}

TEST_F(Tool, RefusesWrongUsage) {
  const auto refuses = [this](const std::string& arguments, const std::string& message) {
    expect("$S " + arguments + " </dev/null", 2, "", "hs-sample: " + message + "\n");
  };
  refuses("--efects a", "unknown flag '--efects'; did you mean '--effects'?");
  refuses("--efects=a b c", "unknown flag '--efects'; did you mean '--effects'?");
  refuses("--frobnicate", "unknown flag '--frobnicate'; hs-sample --help lists the flags");
  refuses("-x", "unknown flag '-x'; hs-sample --help lists the flags");
  refuses("-threads 3", "unknown flag '-threads'; did you mean '--threads'?");
  refuses("a b", "'b' is one input too much; there is one input; give others by their flags");
  refuses("--unit feet", "--unit is 'feet'; known are: m mm cm");
  refuses("--unit mmm", "--unit is 'mmm'; did you mean 'mm'? known are: m mm cm");
  refuses("--unit", "--unit needs a value UNIT; Unit of lengths.");
  refuses("--unit --echo", "--unit needs a value UNIT; Unit of lengths.");
  refuses("--unit= a", "--unit needs a value UNIT; Unit of lengths.");
  refuses("--unit m --unit mm", "--unit is given twice; give it once");
  refuses("--ratio 0.5x", "--ratio is '0.5x', not a number; give a number such as 0.5 or 1e-3");
  refuses("--ratio nan", "--ratio is 'nan', not a number; give a number such as 0.5 or 1e-3");
  refuses("--ratio 0.6", "--ratio is 0.6; give a number from -1 to 0.5");
  refuses("--threads 0", "--threads is 0; give a number of at least 1");
  refuses("--threads 1.5", "--threads is '1.5'; give a whole number");
  refuses("--effects a,,b", "a value of --effects is empty; give a value NAMES");
  refuses("-o ''", "a value of --output is empty; give a value FILE");
  refuses("''", "the name of the input is empty; name a file, or '-'");
  refuses("--effects -q a", "--effects needs a value NAMES; Effects.");
  refuses("--echo=3 a", "--echo takes no value; leave out what follows it");
  refuses("-q -v", "--quiet and --verbose contradict each other; give one of them");
}

TEST_F(Tool, MapsWhatIsThrownToExitCodes) {
  expect("$S --act check a", 1, "", "");
  expect("$S --act error a", 3, "", "hs-sample: data.csv:17: a bad ?[31mcell; mend it\n");
  expect("$S --act throw a", 4, "", "hs-sample: internal error: a bug; please report it\n");
  expect("$S --act memory a", 4, "",
         "hs-sample: there is not enough memory; use a coarser mesh or a smaller file\n");
  expect(
      "$S none", 5, "",
      "hs-sample: none: cannot be opened: No such file or directory; check the name and that its "
      "folder exists\n");
  EXPECT_TRUE(work_.empty());
}

TEST_F(Tool, ChecksStandardOutput) {
  const std::string full =
      "hs-sample: standard output: cannot be written: No space left on device; free some space or "
      "write elsewhere\n";
  for (const char* what : {"--echo a", "--help", "--man", "--version", "--act flood"})
    expect(std::string("$S ") + what + " >/dev/full", 5, "", full);
  expect("$S --echo >&-", 5, "",
         "hs-sample: standard output: cannot be written: Bad file descriptor; it is closed; "
         "redirect it or name a file\n");
}

TEST_F(Tool, LeavesNothingWhenAWriteFails) {
  expect("echo x | $S --other a -o /dev/full", 5, "",
         "hs-sample: /dev/full: cannot be written: No space left on device; free some space or "
         "write elsewhere\n");
  EXPECT_TRUE(work_.empty());
  const Outcome limited =
      work_.run("ulimit -f 1; $S --act flood -o big 2>&1 | cat; exit ${PIPESTATUS[0]}");
  EXPECT_EQ(limited.code, 5);
  EXPECT_NE(limited.out.find("File too large"), std::string::npos) << limited.out;
  EXPECT_TRUE(work_.empty());
}

TEST_F(Tool, EndsSilentlyWhenThePipeIsClosed) {
  const std::string first = "a line of some length\n";
  expect("$S --act flood --other a | head -1; exit ${PIPESTATUS[0]}", 141, first, "");
  expect("trap '' PIPE; $S --act flood --other a | head -1; exit ${PIPESTATUS[0]}", 5, first, "");
  EXPECT_TRUE(work_.empty());
}

TEST_F(Tool, LeavesNothingWhenItIsKilled) {
  for (const int number : {SIGINT, SIGTERM, SIGHUP}) {
    const Outcome outcome = work_.run(
        "set -m; $S a --act wait -o b 2>said & "
        "until [ -s said ]; do sleep 0.01; done; kill -" +
        std::to_string(number) + " $!; wait $!; code=$?; rm said; exit $code");
    EXPECT_EQ(outcome.code, 128 + number) << outcome.err;
    EXPECT_TRUE(work_.empty());
  }
}

// script(1) gives a command a terminal.
TEST_F(Tool, DoesNotWaitForATerminal) {
  HAPSIM_NEEDS_PROGRAM("script");
  const Outcome outcome = work_.run("script -qec \"NO_COLOR=1 $S\" /dev/null");
  EXPECT_EQ(outcome.code, 2);
  EXPECT_EQ(outcome.out,
            "hs-sample: there is no input; name a file or pipe data in; hs-sample --help\r\n");
  EXPECT_NE(work_.run("script -qec \"TERM=xterm $S\" /dev/null").out.find("\033[1;31mhs-sample:"),
            std::string::npos);
  EXPECT_NE(work_.run("script -qec \"head -c 9 /dev/zero | $S -\" /dev/null")
                .out.find("the result is binary and standard output is a terminal"),
            std::string::npos);
}

TEST_F(Tool, ShowsProgressOnATerminalOnly) {
  expect("$S a --act progress", 0, "", "");
  HAPSIM_NEEDS_PROGRAM("script");
  const Outcome shown = work_.run("script -qec \"$S a --act progress\" /dev/null");
  EXPECT_NE(shown.out.find("steps "), std::string::npos) << shown.out;
  EXPECT_NE(shown.out.find("/40, about "), std::string::npos) << shown.out;
  EXPECT_TRUE(shown.out.ends_with("\r\033[K"));
  EXPECT_EQ(work_.run("script -qec \"$S -q a --act progress\" /dev/null").out, "");
}

// A step that takes long, one of a count, and names of what runs; a line that is said stands alone.
TEST_F(Tool, ShowsWhatIsBeingDone) {
  HAPSIM_NEEDS_PROGRAM("script");
  const std::string shown = work_.run("script -qec \"$S a --act states\" /dev/null").out;
  EXPECT_NE(shown.find("\rtesting friction 3/31, about "), std::string::npos) << shown;
  EXPECT_NE(shown.find("\r1/8 done, about "), std::string::npos) << shown;
  EXPECT_NE(shown.find("running: cycles auto"), std::string::npos) << shown;
  EXPECT_NE(shown.find("\r\033[Khs-sample: said\r\n"), std::string::npos) << shown;
  expect("$S a --act states", 0, "", "hs-sample: said\n");
}

// Before the input is even read.
TEST_F(Tool, ChecksItsOutputsBeforeTheWork) {
  for (const char* flag : {"-o", "--other"}) {
    const Outcome outcome = work_.run("$S missing " + std::string(flag) + " nowhere/x.csv");
    EXPECT_EQ(outcome.code, 5);
    EXPECT_EQ(outcome.err,
              "hs-sample: nowhere/x.csv: cannot be created: No such file or directory; check the "
              "name and that its folder exists\n");
  }
  EXPECT_EQ(work_.run("$S missing -o .").err,
            "hs-sample: .: cannot be written: Is a directory; name a file, not a folder\n");
}

TEST_F(Tool, PrintsItsVersion) {
  expect("$S -V", 0, "hs-sample (hapsim) " + version() + "\n", "");
  expect("$S --nonsense --version", 0, "hs-sample (hapsim) " + version() + "\n", "");
}

TEST_F(Tool, HelpFitsInEightyColumns) {
  const Outcome help = work_.run("$S --help");
  EXPECT_EQ(help.code, 0);
  std::istringstream lines(help.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 81u) << line;
  for (const char* part :
       {"Usage: hs-sample [OPTIONS] [INPUT]\n", "\nColumns of the result:\n  x  ",
        "  hs-sample data.csv -o copy.csv\n      Copies a file.\n",
        "  5  reading or writing failed", "-o, --output FILE", "A number from -1 to 0.5.",
        "One of: m, mm, cm. Default: m."})
    EXPECT_NE(help.out.find(part), std::string::npos) << part;
}

TEST_F(Tool, ShortHelpIsAScreen) {
  const Outcome help = work_.run("$S -h");
  EXPECT_EQ(help.code, 0);
  EXPECT_EQ(help.out,
            "hs-sample: copy the input, for tests\n"
            "\n"
            "Usage: hs-sample [OPTIONS] [INPUT]\n"
            "\n"
            "  INPUT                   Any bytes. Standard input when absent or -.\n"
            "\n"
            "Options:\n"
            "  --unit --ratio --threads --effects --other --echo --act -o,--output -q,--quiet\n"
            "    -v,--verbose -h,--help --man -V,--version\n"
            "\n"
            "Examples:\n"
            "  hs-sample data.csv -o copy.csv\n"
            "\n"
            "What each option does: hs-sample --help, or man hs-sample\n");
}

TEST_F(Tool, ManPageIsClean) {
  HAPSIM_NEEDS_PROGRAM("mandoc");
  HAPSIM_NEEDS_PROGRAM("col");
  expect("$S --man >page.1; mandoc -Tlint page.1", 0, "", "");
  const Outcome page = work_.run("mandoc -Tascii page.1 | col -b");
  for (const char* part : {"hs-sample - copy the input, for tests", ".A second paragraph",
                           "back\\slash", "hs-compare(1), hs-simulate(1)", "--ratio R"})
    EXPECT_NE(page.out.find(part), std::string::npos) << part << page.out;
}

}  // namespace
}  // namespace hapsim
