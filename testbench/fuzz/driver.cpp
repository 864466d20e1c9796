// Runs a fuzz target without libFuzzer: every file of the corpus, then `executions` inputs made from them by chance.
//   fuzz_commands CORPUS [EXECUTIONS [SEED]]
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "testbench/fuzz/target.h"

namespace {

using Input = std::string;

void run(const Input& input) {
  (void)LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
}

std::vector<Input> read(const char* folder) {
  std::vector<Input> corpus;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  for (const auto& file : files) {
    std::ifstream in(file, std::ios::binary);
    corpus.emplace_back(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>());
  }
  return corpus;
}

class Mutator {
 public:
  Mutator(std::vector<Input> corpus, unsigned seed) : corpus_(std::move(corpus)), random_(seed) {}

  Input next() {
    Input input = some();
    for (std::size_t i = 0, changes = 1 + below(6); i < changes; ++i) change(input);
    return input;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  const Input& some() { return corpus_[below(corpus_.size())]; }
  Input piece() {
    const Input& from = some();
    if (from.empty()) return from;
    return from.substr(below(from.size()), 1 + below(24));
  }

  void change(Input& input) {
    if (input.empty()) input = some();
    if (input.empty()) return;
    const std::size_t at = below(input.size());
    switch (below(6)) {
      case 0:
        input[at] = static_cast<char>(below(256));
        break;
      case 1:
        input[at] = static_cast<char>(static_cast<unsigned char>(input[at]) ^ 1u << below(8));
        break;
      case 2:
        input.erase(at, 1 + below(8));
        break;
      case 3:
        input.insert(at, input.substr(below(input.size()), 1 + below(16)));
        break;
      default:
        input.insert(at, piece());
    }
  }

  std::vector<Input> corpus_;
  std::mt19937 random_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || !std::filesystem::is_directory(argv[1])) {
    std::fprintf(stderr, "usage: %s CORPUS [EXECUTIONS [SEED]], CORPUS a folder of inputs\n", argv[0]);
    return 2;
  }
  const std::vector<Input> corpus = read(argv[1]);
  if (corpus.empty()) {
    std::fprintf(stderr, "%s: no input in it\n", argv[1]);
    return 2;
  }
  const unsigned long executions = argc > 2 ? std::strtoul(argv[2], nullptr, 10) : 0;
  for (const Input& input : corpus) run(input);
  Mutator mutator(corpus, argc > 3 ? static_cast<unsigned>(std::strtoul(argv[3], nullptr, 10)) : 1);
  for (unsigned long i = 0; i < executions; ++i) { run(mutator.next()); }
  std::printf("%zu inputs of the corpus, %lu made from them\n", corpus.size(), executions);
  return 0;
}
