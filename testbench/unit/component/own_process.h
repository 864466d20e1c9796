// SystemC elaborates once in a process, so each simulation gets one of its own. What fails in there fails the test.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>

#include <gtest/gtest.h>

namespace brick::component {

template <class Simulation>
void in_own_process(const Simulation& simulation) {
  std::fflush(nullptr);
  const pid_t child = fork();
  ASSERT_NE(child, -1);
  if (child == 0) {
    try {
      simulation();
    } catch (const std::exception& error) { ADD_FAILURE() << error.what(); }
    std::fflush(nullptr);
    std::exit(::testing::Test::HasFailure() ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << "the simulation failed, see above";
}

}  // namespace brick::component
