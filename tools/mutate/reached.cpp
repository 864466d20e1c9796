// Linked into a test program with mutants of C: BRICK_MUTANT chooses one by its number, and the file BRICK_REACHED gets
// a line for each test: its name, the milliseconds it took, the numbers of the mutants that it came to.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

extern "C" {
unsigned brick_mutant_number;
unsigned char brick_mutant_reached[BRICK_MUTANTS + 1];

// Before the constructors of the program.
__attribute__((constructor(101))) static void choose() {
  const char* number = std::getenv("BRICK_MUTANT");
  brick_mutant_number = number ? static_cast<unsigned>(std::atoi(number)) : 0u;
}
}

namespace {

class Recorder : public testing::EmptyTestEventListener {
 public:
  explicit Recorder(const char* file) : out(file) {}

 private:
  void OnTestEnd(const testing::TestInfo& test) override {
    out << test.test_suite_name() << '.' << test.name() << ' ' << test.result()->elapsed_time();
    for (unsigned n = 1; n <= BRICK_MUTANTS; ++n) {
      if (brick_mutant_reached[n]) out << ' ' << n;
      brick_mutant_reached[n] = 0;
    }
    out << std::endl;
  }

  std::ofstream out;
};

const bool recording = [] {
  const char* file = std::getenv("BRICK_REACHED");
  if (file) testing::UnitTest::GetInstance()->listeners().Append(new Recorder(file));
  return file != nullptr;
}();

}  // namespace
