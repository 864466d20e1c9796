// brick_vectors [--engine NAME] [--draw | --negative] FILE: runs a timing vector, prints what failed, the WaveDrom
// source of its figure, or for each of its faults the expectation that finds it. Exit status as the `brick` command's:
// 0 passed, 1 failed, 2 bad usage or a mistake in the file.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>

#include "systemc/core/usage_error.h"
#include "testbench/unit/vectors/wave.h"

namespace {

brick::Vector read(const std::string& path, const std::string& engine) {
  brick::Vector vector = brick::read_vector(path);
  const auto& known = vector.kind().engines;
  if (std::find(known.begin(), known.end(), engine) == known.end())
    throw brick::UsageError(fmt::format("--engine {}: no such engine; expected {}", engine, fmt::join(known, ", ")));
  return vector;
}

int run(const std::string& path, const std::string& engine, bool draw) {
  const brick::Vector vector = read(path, engine);
  if (draw && !vector.wave) throw brick::UsageError(path + ": key wave is missing; expected [wave] to draw");
  const auto device = brick::make_device(vector.device, engine, vector.board);
  const brick::RunResult result = brick::run_vector(vector, *device);
  if (!result.passed()) {
    fmt::print(stderr, "{}", result.text());
    return 1;
  }
  if (draw) {
    fmt::print("{}", brick::wavedrom(vector, result));
  } else {
    fmt::print("{}: passed on {}, {} checks, {} ticks\n", path, engine, result.checks, device->now());
  }
  return 0;
}

int run_negatives(const std::string& path, const std::string& engine) {
  const brick::Vector vector = read(path, engine);
  int status = 0;
  const brick::RunResult right = brick::run_vector(vector, *brick::make_device(vector.device, engine, vector.board));
  if (!right.passed()) {  // of each fault too, which would say nothing
    fmt::print(stderr, "{}: fails without a fault; expected a vector that passes\n{}", path, right.text());
    return 1;
  }
  for (const brick::Corruption& corruption : vector.negatives) {
    const auto device = brick::make_device(vector.device, engine, vector.board);
    const brick::RunResult result = brick::run_vector(vector, *device, &corruption);
    if (result.failures.empty()) status = 1;
    fmt::print("{}\n    {}\n", corruption.name, result.failures.empty() ? "NOT FOUND" : result.failures.front());
  }
  return status;
}

// A figure that got lost has not been drawn.
int with_output_written(int status) {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return status;
  fmt::print(stderr, "stdout took no more; expected room for what is printed\n");
  return 1;
}

}  // namespace

// NOLINTNEXTLINE(bugprone-exception-escape): only options that contradict each other, in every run
int main(int argc, char** argv) {
  std::string path, engine = "systemc";
  bool draw = false, negative = false;
  CLI::App app{"Runs a timing vector"};
  app.add_option("--engine", engine,
                 "what it runs on: rtl, systemc (default), both, board_rtl, board_systemc, board_both");
  app.add_flag("--draw", draw, "print the figure as WaveDrom source");
  app.add_flag("--negative", negative, "run it with each of its planted faults");
  app.add_option("FILE", path)->required();
  try {
    app.parse(argc, argv);
    return with_output_written(negative ? run_negatives(path, engine) : run(path, engine, draw));
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const brick::UsageError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}: {}\n", path, error.what());
    return 2;
  }
}
