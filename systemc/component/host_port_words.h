// Where the packed words of the host port's component have its pins.
#pragma once

namespace brick::component::host_port_words {

constexpr unsigned kRstN = 0, kResetDrv = 1;                   // of input word 0
constexpr unsigned kHreq = 0, kIrq = 1, kTxde = 2, kRxdf = 3;  // of output word 0
constexpr unsigned kHost = 0, kCpu = 1;                        // faces
constexpr unsigned kHostBytes = 8, kCpuBytes = 6 * 4;          // addresses; X:$FFFFC2 + n is at 4 n

}  // namespace brick::component::host_port_words
