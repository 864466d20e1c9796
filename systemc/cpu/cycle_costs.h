// What each instruction costs in CPU clock cycles: the one table of the timing model. It is a choice, made after a
// small in-order core with a single-issue pipeline. docs/cpu.md prints it, testbench/unit/cpu/timing_test.cpp checks
// it.
#pragma once

#include "systemc/cpu/cpu.h"

namespace brick::cost {

constexpr Cycle kSimple = 1;       // integer arithmetic, lui, auipc, fence, branch not taken, wfi
constexpr Cycle kLoad = 2;         // plus the region's wait, or the time of the device access
constexpr Cycle kStore = 1;        // the same
constexpr Cycle kBranchTaken = 2;  // conditional branch that is taken
constexpr Cycle kJump = 2;         // jal, jalr
constexpr Cycle kMul = 2;          // mul
constexpr Cycle kMulHigh = 3;      // mulh, mulhsu, mulhu
constexpr Cycle kDivide = 20;      // div, divu, rem, remu, whatever the operands
constexpr Cycle kCsr = 2;          // csrrw and its kin
constexpr Cycle kFenceI = 4;       // fence.i
constexpr Cycle kMret = 4;         // mret
constexpr Cycle kTrap = 4;         // from the boundary at which a trap is taken to the first instruction of its handler

}  // namespace brick::cost
