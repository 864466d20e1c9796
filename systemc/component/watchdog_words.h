// Where the packed words of the watchdog's component have its pins.
#pragma once

namespace brick::component::watchdog_words {

constexpr unsigned kRstN = 0, kServo = 1, kPwrGood = 2;  // of input word 0
constexpr unsigned kTrip = 0, kRelay = 1;                // of output word 0

}  // namespace brick::component::watchdog_words
