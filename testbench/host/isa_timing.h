// The host's ISA / PC104 cycles as points in time (host-bus:3.4): BCLK 8.333 MHz, every point counted from the BCLK
// edge at which the cycle starts. An 8-bit I/O cycle takes 6 BCLK, a 16-bit memory cycle 3 BCLK and one of recovery.
#pragma once

#include "systemc/core/ticks.h"

namespace brick::isa {

constexpr TimeFs kBclk = 120 * kFsPerNs;

struct CycleTimes {
  TimeFs command_low;   // address is valid from 0: this is t1 (>= 91 ns; LA of a memory cycle >= 111 ns)
  TimeFs data_valid;    // write data is driven from here: before the command, t6 allows 22 ns after it
  TimeFs command_high;  // t2 = command_high - command_low (>= 530 ns for I/O, 219 ns for memory), stretched by IOCHRDY
  TimeFs release;       // address and data are let go: t3, t7 = release - command_high (>= 25 ns)
  TimeFs next;          // earliest start of the next cycle, so that t11 (>= 170 ns) holds
};

constexpr CycleTimes kIo{120 * kFsPerNs, 60 * kFsPerNs, 660 * kFsPerNs, 700 * kFsPerNs, 720 * kFsPerNs};
constexpr CycleTimes kMemory{120 * kFsPerNs, 60 * kFsPerNs, 360 * kFsPerNs, 400 * kFsPerNs, 480 * kFsPerNs};

constexpr TimeFs kReadSetup = 10 * kFsPerNs;  // the host looks at the data this long before it raises the command
constexpr TimeFs kReadyToHigh = kBclk;        // t9: IOCHRDY high for one BCLK before the command goes high
constexpr TimeFs kLongestStretch = 15'600 * kFsPerNs;  // t10

constexpr TimeFs kPollPause = 12 * kBclk;  // what a host program does between two looks at a status register

static_assert(kIo.command_low >= 91 * kFsPerNs && kIo.command_high - kIo.command_low >= 530 * kFsPerNs, "t1, t2");
static_assert(kIo.release - kIo.command_high >= 25 * kFsPerNs, "t3, t7");
static_assert(kIo.next + kIo.command_low - kIo.command_high >= 170 * kFsPerNs, "t11");
static_assert(kMemory.command_low >= 111 * kFsPerNs && kMemory.command_high - kMemory.command_low >= 219 * kFsPerNs,
              "memory t1, t2");
static_assert(kMemory.release - kMemory.command_high >= 25 * kFsPerNs, "memory hold");

}  // namespace brick::isa
