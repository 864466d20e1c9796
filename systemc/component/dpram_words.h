// Where the packed words of the dual-ported RAM's component have its pins. Output word 1 is what was read last: the
// CPU's word, above it the host's.
#pragma once

namespace brick::component::dpram_words {

constexpr unsigned kRstN = 0, kSmall = 1;        // of input word 0
constexpr unsigned kBusyHost = 0, kBusyCpu = 1;  // of output word 0
constexpr unsigned kHost = 0, kCpu = 1;          // faces
constexpr unsigned kBytes = 0x10000, kSmallBytes = 0x4000;

}  // namespace brick::component::dpram_words
