// Where the packed words of the host signals' component have its pins, and its two registers.
#pragma once

namespace brick::component::host_signals_words {

constexpr unsigned kRstN = 0;                           // of input word 0
constexpr unsigned kSignals = 0, kControl = 4;          // of output word 0: IPOS, BREQ, EROR, F1ER; CTRL0, CTRL1
constexpr unsigned kSignalsByte = 0, kControlByte = 4;  // addresses

}  // namespace brick::component::host_signals_words
