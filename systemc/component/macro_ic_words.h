// Where the packed words of the MACRO IC's component have its pins.
#pragma once

namespace brick::component::macro_ic_words {

constexpr unsigned kRstN = 0, kGate = 1, kPhaseIn = 2, kServoIn = 3;    // of input word 0
constexpr unsigned kPhase = 0, kPhaseOe = 1, kServo = 2, kServoOe = 3;  // of output word 0
constexpr unsigned kAddresses = 64 * 8;                                 // bytes of all registers

}  // namespace brick::component::macro_ic_words
