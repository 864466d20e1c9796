// The host's ISA / PC104 cycles as points in time (host-bus:3.4), counted from the start of a cycle. BCLK is 8.333 MHz:
// an 8-bit cycle takes 6 BCLK, an I/O cycle one more of recovery, a 16-bit memory cycle 3 BCLK and one of recovery. A
// host is typical, slow, or at the limit of every rule at once.
#pragma once

#include "systemc/core/ticks.h"

namespace brick::isa {

constexpr TimeFs kBclk = 120 * kFsPerNs;
constexpr TimeFs ns(std::int64_t time) { return time * kFsPerNs; }

struct CycleTimes {
  TimeFs address;       // SA, SBHE#, AEN are valid; LA from 0 to the fall of the command
  TimeFs command_low;   // command_low - address is t1 (>= 91 ns), command_low of a memory cycle >= 111 ns (LA)
  TimeFs data_valid;    // write data is driven: t6 allows 22 ns after the command
  TimeFs sample;        // read data is looked at so long before the command ends
  TimeFs command_high;  // t2 = command_high - command_low (>= 530 ns, 16-bit memory 219 ns), stretched by IOCHRDY
  TimeFs release;       // address and data are let go: t3, t7 = release - command_high (>= 25 ns)
  TimeFs next;          // earliest start of the next cycle, so that t11 (>= 170 ns) holds
};

struct HostTimes {
  CycleTimes io, memory, memory8;  // an 8-bit memory cycle takes as long as an I/O cycle
  TimeFs grid;                     // cycles start at a multiple of it
  bool exact_ready;                // ends exactly t9 after IOCHRDY, not with the next BCLK
};

// A PC leaves a BCLK of recovery after an I/O cycle: 300 ns between two strobes, which the host port needs of a CPU at
// its slowest clock (host-bus:3.3, 257.6 ns at I52 = 0).
constexpr CycleTimes kIo{0, ns(120), ns(60), ns(10), ns(660), ns(700), ns(840)};
constexpr CycleTimes kMemory8{0, ns(120), ns(60), ns(10), ns(660), ns(700), ns(720)};
constexpr CycleTimes kMemory{0, ns(120), ns(60), ns(10), ns(360), ns(400), ns(480)};
constexpr CycleTimes kSlowIo{0, ns(360), ns(120), ns(10), ns(1560), ns(1800), ns(2400)};
constexpr CycleTimes kSlowMemory{0, ns(360), ns(120), ns(10), ns(960), ns(1200), ns(1800)};
// t1 91, t2 530, t3 25, t4 489, t6 22, t11 170; LA 111, SA 34 before a memory command of 219, data after 173.
constexpr CycleTimes kTightIo{0, ns(91), ns(91 + 22), ns(530 - 489), ns(91 + 530), ns(621 + 25), ns(621 + 170 - 91)};
constexpr CycleTimes kTightMemory{ns(111 - 34),  ns(111),      ns(111 + 22),      ns(219 - 173),
                                  ns(111 + 219), ns(330 + 25), ns(330 + 170 - 91)};
constexpr CycleTimes kTightMemory8{ns(111 - 34),  ns(111),      ns(111 + 22),      ns(530 - 489),
                                   ns(111 + 530), ns(641 + 25), ns(641 + 170 - 91)};

constexpr HostTimes kTypical{kIo, kMemory, kMemory8, kBclk, false};
constexpr HostTimes kSlow{kSlowIo, kSlowMemory, kSlowIo, kBclk, false};
constexpr HostTimes kTight{kTightIo, kTightMemory, kTightMemory8, ns(1), true};

constexpr TimeFs kMemcs16 = ns(66);                    // MEMCS16# is looked at so long after LA
constexpr TimeFs kReadyToHigh = kBclk;                 // t9: IOCHRDY high for one BCLK before the command goes high
constexpr TimeFs kLongestStretch = 15'600 * kFsPerNs;  // t10

// What a host program does between two looks at a status register: a sixteenth of the wait so far, within these.
constexpr TimeFs kPollPause = 12 * kBclk, kLongestPollPause = ns(50'000);
constexpr std::int64_t kLooksAWait = 16;

}  // namespace brick::isa
