// Where the packed words of the interrupt controller's component have its pins. Output word 0 is its registers.
#pragma once

namespace brick::component::interrupt_controller_words {

constexpr unsigned kLine = 0, kResetDrv = 8, kRstN = 9;  // of input word 0
constexpr unsigned kIrq = 0;                             // of output word 1

}  // namespace brick::component::interrupt_controller_words
