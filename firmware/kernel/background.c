/* Looked at after every interrupt: no call stands between the flag and its users. */
#include "firmware/kernel/background.h"

volatile uint32_t background_work;
