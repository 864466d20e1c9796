// The tasks that a profile tells apart: what an interrupt has begun, and the background.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace brick {

enum class ProfiledTask : unsigned { kBackground, kRealTime, kHostPort, kServo, kPhase };
constexpr std::size_t kProfiledTasks = 5;
constexpr std::array<const char*, kProfiledTasks> kProfiledTaskNames = {"background", "real-time", "host port", "servo",
                                                                        "phase"};
using TaskCycles = std::array<std::uint64_t, kProfiledTasks>;  // CPU cycles of each

}  // namespace brick
