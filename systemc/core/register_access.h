// What the TLM-2.0 sockets of the host-side blocks have in common: checks of a payload and the way from SystemC time to
// ticks. An access through a socket is what the bus would do: it is made at the first clk_ref edge after its time, and
// the initiator's delay grows to that edge. Bad payloads get TLM error responses.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include <systemc>
#include <tlm>

#include "systemc/core/model_block.h"

namespace brick {

inline TimeFs time_to_fs(const sc_core::sc_time& time) {
  static const auto fs_per_unit =
      static_cast<TimeFs>(std::llround(sc_core::sc_get_time_resolution().to_seconds() * 1e15));
  return static_cast<TimeFs>(time.value()) * fs_per_unit;
}

// Delay from the present SystemC time to the edge of `tick`, not negative.
inline sc_core::sc_time delay_until(Tick tick) {
  const TimeFs fs = tick_to_fs(tick) - time_to_fs(sc_core::sc_time_stamp());
  return sc_core::sc_time(fs > 0 ? static_cast<double>(fs) : 0.0, sc_core::SC_FS);
}

// Lets `block` execute everything up to the time of the access. Returns its next clk_ref edge.
inline Tick catch_up(ModelBlock& block, Tick block_now, const sc_core::sc_time& delay) {
  Tick now = fs_to_tick_floor(time_to_fs(sc_core::sc_time_stamp() + delay));
  if (now < block_now) now = block_now;
  while (block.next_event() <= now) block.advance(block.next_event());
  block.advance(now);
  return next_ref_edge(now);
}

// True when the payload is a plain access of `bytes` bytes, aligned, below `size`; else the response is set.
inline bool check_payload(tlm::tlm_generic_payload& payload, unsigned bytes, std::uint64_t size) {
  if (payload.get_byte_enable_ptr() != nullptr)
    payload.set_response_status(tlm::TLM_BYTE_ENABLE_ERROR_RESPONSE);
  else if (payload.get_data_length() != bytes || payload.get_streaming_width() < bytes)
    payload.set_response_status(tlm::TLM_BURST_ERROR_RESPONSE);
  else if (payload.get_address() % bytes != 0 || payload.get_address() + bytes > size)
    payload.set_response_status(tlm::TLM_ADDRESS_ERROR_RESPONSE);
  else if (payload.get_command() == tlm::TLM_IGNORE_COMMAND)
    payload.set_response_status(tlm::TLM_COMMAND_ERROR_RESPONSE);
  else
    payload.set_response_status(tlm::TLM_OK_RESPONSE);
  return payload.is_response_ok();
}

template <class Value>
Value payload_value(const tlm::tlm_generic_payload& payload) {
  Value value;
  std::memcpy(&value, payload.get_data_ptr(), sizeof value);
  return value;
}

template <class Value>
void set_payload_value(tlm::tlm_generic_payload& payload, Value value) {
  std::memcpy(payload.get_data_ptr(), &value, sizeof value);
}

}  // namespace brick
