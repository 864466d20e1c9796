// The list of the benches, in the order of `brick list`.
#include "testbench/benches/benches.h"

namespace brick {

const std::vector<Bench>& all_benches() {
  static const std::vector<Bench> benches{
      smoke_bench(),
      breq_rotary_bench(),
      breq_select_bench(),
      breq_fixed_bench(),
      binary_rotary_bench(),
      interrupts_bench(),
      dpram_bench(),
      dpram_ascii_bench(),
      dpram_reporting_bench(),
      gather_bench(),
      watchdog_bench(),
      reinit_e3_bench(),
      save_restore_bench(),
      clock_select_bench(),
      clock_faults_bench(),
      clock_macro_bench(),
      encoder_bench(),
      capture_compare_bench(),
      flags_bench(),
      pwm_bench(),
      pfm_bench(),
      serial_dac_adc_bench(),
      host_port_bench(),
      isa_timing_bench(),
      port_a_phase_bench(),
      port_a_hammer_bench(),
      bus_timing_bench(),
      listing_bench(),
      variables_bench(),
      status_bench(),
      plc_bench(),
      servo_loop_bench(),
      jog_home_bench(),
      motion_bench(),
      limits_bench(),
      commutation_bench(),
      time_base_bench(),
      follow_bench(),
      ssi_bench(),
      task_load_bench(),
      circle_bench(),
      lookahead_bench(),
      reversal_bench(),
      kinematics_bench(),
      rotary_machining_bench(),
  };
  return benches;
}

}  // namespace brick
