// Pi, which C++17 has no name for.
#pragma once

constexpr double kPi = 3.14159265358979323846;
