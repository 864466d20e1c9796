// The two registers of the host signals' component.
#pragma once

namespace brick::component::host_signals_words {

constexpr unsigned kSignalsByte = 0, kControlByte = 4, kRegisterBytes = 8;  // addresses

}  // namespace brick::component::host_signals_words
