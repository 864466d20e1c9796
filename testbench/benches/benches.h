// The benches, one function each, and the list of them.
#pragma once

#include "app/bench.h"

namespace brick {

// Every bench there is, in the order of `brick list`.
const std::vector<Bench>& all_benches();

Bench smoke_bench();
Bench bus_timing_bench();
Bench plc_bench();
Bench breq_rotary_bench();
Bench breq_select_bench();
Bench breq_fixed_bench();
Bench binary_rotary_bench();
Bench interrupts_bench();
Bench watchdog_bench();
Bench dpram_bench();
Bench dpram_ascii_bench();
Bench dpram_reporting_bench();
Bench gather_bench();
Bench reinit_e3_bench();
Bench save_restore_bench();
Bench clock_select_bench();
Bench clock_faults_bench();
Bench clock_macro_bench();
Bench encoder_bench();
Bench capture_compare_bench();
Bench flags_bench();
Bench pwm_bench();
Bench pfm_bench();
Bench serial_dac_adc_bench();
Bench port_a_phase_bench();
Bench port_a_hammer_bench();
Bench host_port_bench();
Bench isa_timing_bench();
Bench listing_bench();
Bench variables_bench();
Bench status_bench();
Bench servo_loop_bench();
Bench jog_home_bench();
Bench motion_bench();
Bench kinematics_bench();
Bench limits_bench();
Bench commutation_bench();
Bench ssi_bench();
Bench time_base_bench();
Bench follow_bench();
Bench task_load_bench();
Bench circle_bench();
Bench lookahead_bench();
Bench reversal_bench();
Bench rotary_machining_bench();

}  // namespace brick
