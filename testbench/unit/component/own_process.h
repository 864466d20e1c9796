// SystemC elaborates once in a process, so each simulation gets one of its own. What fails in there fails the test.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <functional>
#include <string>

#include <gtest/gtest.h>
#include <systemc>

namespace brick::component {

template <class Simulation>
void in_own_process(const Simulation& simulation) {
  // The child has the parent's results so far: only what it adds counts.
  const auto results = [] {
    return ::testing::UnitTest::GetInstance()->current_test_info()->result()->total_part_count();
  };
  const int before = results();
  std::fflush(nullptr);
  const pid_t child = fork();
  ASSERT_NE(child, -1);
  if (child == 0) {
    try {
      simulation();
    } catch (const std::exception& error) { ADD_FAILURE() << error.what(); }
    std::fflush(nullptr);
#ifdef __SANITIZE_ADDRESS__
    // It ends inside of a test, whose objects are no leaks.
    std::_Exit(results() > before ? 1 : 0);
#endif
    std::exit(results() > before ? 1 : 0);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_TRUE(WIFEXITED(status)) << "signal " << WTERMSIG(status);
  EXPECT_EQ(WEXITSTATUS(status), 0) << "the simulation failed, see above";
}

// Type of the report that ends it, "" when none does.
inline std::string error_of(const std::function<void()>& simulation) {
  try {
    simulation();
  } catch (const sc_core::sc_report& report) { return report.get_msg_type(); }
  return "";
}

}  // namespace brick::component
