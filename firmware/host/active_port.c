#include "firmware/host/active_port.h"

enum program_port active_port;
