// Named signals as a user speaks of them: found by full name or by its end, shown as text, waited for.
#pragma once

#include <optional>
#include <string>

#include "testbench/host/host_bus.h"

namespace brick {

// `host.breq`, `brick.host.breq`, or `breq` where only one name ends so. Throws UsageError.
Signals::Id find_signal(const Signals& signals, const std::string& name);

// The input pin of a channel that this names, as find_signal(). Throws UsageError.
struct ChannelPinPlace {
  unsigned ic, channel, pin;  // pin as in ChannelPin
};
ChannelPinPlace find_channel_pin(const Signals& signals, const std::string& name);

// The pin of a connector beside the channels that this names: host.mi1, host.mi2, host.axexp0, host.axexp1; nothing if
// it is none.
std::optional<bool HostInputs::*> find_connector_pin(const Signals& signals, const std::string& name);

// Binary and decimal signals in decimal, hexadecimal ones with `$`, text as it is.
std::string signal_text(const Signals& signals, Signals::Id id);

// `value` as signal_text would show it: decimal, $hex or 0xhex become the same form. Throws UsageError.
std::string signal_value_text(const Signals& signals, Signals::Id id, const std::string& value);

// Advances until the signal shows `value` (as from signal_value_text). A pin is seen at its edge, any other signal is
// looked at every 16 ticks. False at the time-out.
bool wait_signal(HostBus& bus, Signals::Id id, const std::string& value, Tick timeout);

}  // namespace brick
