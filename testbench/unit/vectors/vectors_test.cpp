// One test for each vector file and engine, one in which it must fail, one for its figure. Registered by name, so that
// `ctest -R vectors.pwm` runs what it says.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <set>
#include <sstream>

#include "systemc/core/usage_error.h"
#include "testbench/unit/vectors/wave.h"

namespace brick {
namespace {

constexpr const char* kVectors = "testbench/vectors";
constexpr const char* kFigures = "docs/images/vectors/";

// Every vector there is: one that is gone would not be missed by the tests that are made of what is found.
const std::set<std::string> kNames = {
    "adc_strobe", "adc_word",     "alignment",          "capture_armed",  "capture_home",    "capture_index",
    "compare",    "dac_strobe",   "decode_direction",   "default_words",  "encoder_error",   "encoder_filter",
    "equ_write",  "hall",         "hardware_clocks",    "isa_read_waits", "isa_write_waits", "mldt",
    "pfm",        "phase_clock",  "port_a_read",        "port_a_write",   "pwm_command",     "pwm_dead_time",
    "pwm_update", "reinitialize", "reinitialize_macro", "trip",           "turnaround",      "ssi_change",
    "ssi_frame",  "ssi_geo",      "ssi_parity",         "ssi_trigger"};

std::vector<std::string> vector_files() {
  std::vector<std::string> found;
  std::error_code none;  // a folder that is not there has none of them
  for (const auto& entry : std::filesystem::directory_iterator(kVectors, none))
    if (entry.path().extension() == ".vec") found.push_back(entry.path().string());
  std::sort(found.begin(), found.end());
  return found;
}

class VectorTest : public ::testing::Test {
 public:
  explicit VectorTest(std::function<void()> body) : body_(std::move(body)) {}
  void TestBody() override { body_(); }

 private:
  std::function<void()> body_;
};

void add(const std::string& name, std::function<void()> body) {
  ::testing::RegisterTest("vectors", name.c_str(), nullptr, nullptr, __FILE__, __LINE__,
                          [body = std::move(body)]() -> ::testing::Test* { return new VectorTest(body); });
}

RunResult run(const Vector& vector, const std::string& engine, const Corruption* corruption = nullptr) {
  const auto device = make_device(vector.device, engine, vector.board);
  return run_vector(vector, *device, corruption);
}

void passes(const std::string& file, const std::string& engine) {
  const RunResult result = run(read_vector(file), engine);
  EXPECT_TRUE(result.passed()) << result.text();
}

void fails_when_corrupted(const std::string& file) {
  const Vector vector = read_vector(file);
  EXPECT_FALSE(vector.negatives.empty()) << file << " has no negative control";
  for (const std::string engine : {"systemc", "rtl"}) {
    if (engine == "rtl" && vector.device == "controller") break;  // one is enough to show what its steps tell apart
    const RunResult right = run(vector, engine);
    ASSERT_TRUE(right.passed()) << "it fails anyhow: " << right.text();
    for (const Corruption& corruption : vector.negatives)
      EXPECT_FALSE(run(vector, engine, &corruption).failures.empty())
          << file << " passes on " << engine << " although: " << corruption.name;
  }
}

// The committed figure is the one that either engine draws.
void figure_is_fresh(const std::string& file) {
  const Vector vector = read_vector(file);
  const std::string path = kFigures + vector.name + ".json";
  std::ifstream in(path);
  std::ostringstream committed;
  committed << in.rdbuf();
  for (const char* engine : {"systemc", "rtl"}) {
    const RunResult result = run(vector, engine);
    ASSERT_TRUE(result.passed()) << result.text();
    EXPECT_EQ(wavedrom(vector, result), committed.str())
        << path << " is stale on " << engine << ": run tools/draw_vectors.py";
  }
}

// PHASE and SERVO are pins of an IC by itself; on the board they are nets that the board makes.
bool drives_a_net(const std::string& file) {
  std::ifstream in(file);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  return text.find("\npin clock.") != std::string::npos;
}

// Before main(), where the TEST macros register theirs. A file that cannot be read is a test that fails.
void add_tests_of(const std::string& file) {
  const std::string name = std::filesystem::path(file).stem().string();
  try {
    const Vector vector = read_vector(file);
    for (const std::string& engine : vector.kind().engines)
      if (!drives_a_net(file) || engine.find("board") != 0)
        add(name + "_" + engine, [file, engine] { passes(file, engine); });
    add("negative_" + name, [file] { fails_when_corrupted(file); });
    if (vector.wave) add("figure_" + name, [file] { figure_is_fresh(file); });
  } catch (const UsageError& error) {
    add(name, [what = std::string(error.what())] { FAIL() << what; });
  }
}
const bool kRegistered = [] {
  for (const std::string& file : vector_files()) add_tests_of(file);
  return true;
}();

TEST(CheckVectors, NoneIsGone) {
  std::set<std::string> found;
  for (const std::string& file : vector_files()) found.insert(std::filesystem::path(file).stem().string());
  EXPECT_EQ(found, kNames) << "in " << kVectors;
}

// All check vectors of the servo IC's data sheet (servo-ic:14) are there.
TEST(CheckVectors, EveryNumberHasAFile) {
  constexpr int kCheckVectors = 17;
  ASSERT_TRUE(kRegistered);
  std::set<int> numbers;
  for (const std::string& file : vector_files()) {
    const Vector vector = read_vector(file);
    if (vector.number) numbers.insert(*vector.number);
  }
  for (int n = 1; n <= kCheckVectors; ++n) EXPECT_EQ(numbers.count(n), 1u) << "check vector " << n;
}

// The comparison of the engines fails when one of them does something else.
TEST(BothEngines, ADifferenceIsFound) {
  auto rtl = make_channels(true), model = make_channels(false);
  Device& one = *model;
  const auto both = compared(std::move(rtl), std::move(model));
  both->reset();
  both->write(true, 0x04, 0x3008D2);
  both->run(1000);
  one.write(true, 0x1C, 0x197F0E);
  EXPECT_THROW(both->run(100'000), DeviceError);
}

}  // namespace
}  // namespace brick
