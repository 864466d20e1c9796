// A fuzzed part of the project. The entry point is libFuzzer's, so that it runs under libFuzzer (libfuzzer/) and under
// the driver that needs nothing but the project's compiler (driver.cpp). What must not be ends the process.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

inline void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "fuzz: %s\n", what);
  std::abort();
}
