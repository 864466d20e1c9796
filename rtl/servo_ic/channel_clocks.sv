// What the four channels of a servo IC share: SCLK, PFM_CLK, DAC_CLK, ADC_CLK, the edges of PHASE and SERVO as clk_ref
// sees them, and the strobe words with their serial clocks. A trip of the watchdog starts a DAC stream of its own, of
// zeros, when the one under way has ended: PHASE may have stopped. From then on PHASE cuts no word: it may have become
// too fast. Clock clk_ref_i; on clk_pwm_i run the edges' way to clk_ref_i and the pads of the serial clocks.
// Asynchronous reset, but of what names the edges in a period of clk_ref_i: no stream runs before it is known.
`default_nettype none

module channel_clocks (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        trip_i,
  input  wire logic [11:0] dividers_i,    // I7m03, as in the clock control word
  input  wire logic [23:0] dac_strobe_i,  // I7m05
  input  wire logic [23:0] adc_strobe_i,  // I7m06
  input  wire logic        phase_rise_i,  // this clk_pwm edge raises, lowers PHASE, lowers SERVO
  input  wire logic        phase_fall_i,
  input  wire logic        servo_fall_i,
  output logic             sclk_ce_o,
  output logic             pfm_ce_o,
  output logic             phase_fall_o,
  output logic             servo_fall_o,
  output logic             dac_load_o,
  output logic             dac_shift_o,
  output logic             adc_sample_o,
  output logic [4:0]       adc_bit_o,
  output logic             dac_clk_o,
  output logic             dac_strobe_o,
  output logic             adc_clk_o,
  output logic             adc_strobe_o
);

  // An edge of PHASE or SERVO turns a flip-flop over; the next edge of clk_ref sees the difference.
  logic [2:0] edge_pwm_q, edge_ref_q;
  logic       phase_rise;
  assign {servo_fall_o, phase_fall_o, phase_rise} = edge_pwm_q ^ edge_ref_q;

  // Which of the three clk_pwm edges in a clk_ref period comes next: the two flip-flops differ before the first.
  logic toggle_q, toggle_pwm_q, ref_last, ref_last_q, ref_next_q;
  assign ref_last = toggle_q ^ toggle_pwm_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      edge_ref_q <= 3'd0;
      toggle_q   <= 1'b0;
    end else begin
      edge_ref_q <= edge_pwm_q;
      toggle_q   <= ~toggle_q;
    end
  end

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) edge_pwm_q <= 3'd0;
    else         edge_pwm_q <= edge_pwm_q ^ {servo_fall_i, phase_fall_i, phase_rise_i};
  end

  always_ff @(posedge clk_pwm_i) begin
    toggle_pwm_q <= toggle_q;
    ref_last_q   <= ref_last;
    ref_next_q   <= ref_last_q;
  end

  logic sclk_mid, sclk_fast, pfm_mid, pfm_fast, unused;
  logic dac_ce, dac_mid, dac_fast, adc_ce, adc_mid, adc_fast;
  assign unused = &{1'b0, sclk_mid, sclk_fast, pfm_mid, pfm_fast};

  channel_divider u_sclk (
    .clk_ref_i, .rst_ni,
    .n_i(dividers_i[brick_regs_pkg::ServoIcClockControlSclkDividerLsb +: 3]),
    .ce_o(sclk_ce_o), .mid_o(sclk_mid), .fast_o(sclk_fast)
  );
  channel_divider u_pfm (
    .clk_ref_i, .rst_ni,
    .n_i(dividers_i[brick_regs_pkg::ServoIcClockControlPfmDividerLsb +: 3]),
    .ce_o(pfm_ce_o), .mid_o(pfm_mid), .fast_o(pfm_fast)
  );
  channel_divider u_dac (
    .clk_ref_i, .rst_ni,
    .n_i(dividers_i[brick_regs_pkg::ServoIcClockControlDacDividerLsb +: 3]),
    .ce_o(dac_ce), .mid_o(dac_mid), .fast_o(dac_fast)
  );
  channel_divider u_adc (
    .clk_ref_i, .rst_ni,
    .n_i(dividers_i[brick_regs_pkg::ServoIcClockControlAdcDividerLsb +: 3]),
    .ce_o(adc_ce), .mid_o(adc_mid), .fast_o(adc_fast)
  );

  logic       dac_clk_d, dac_runs_fast, adc_clk_d, adc_runs_fast;
  logic       dac_busy, dac_sample, adc_busy, adc_load, adc_shift, unused_stream;
  logic [4:0] dac_bit;
  assign unused_stream = &{1'b0, dac_sample, dac_bit, adc_busy, adc_load, adc_shift};

  // From the trip until a stream has started since.
  logic tripped_q, zero_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      tripped_q <= 1'b0;
      zero_q    <= 1'b0;
    end else begin
      tripped_q <= trip_i;
      zero_q    <= (trip_i & ~tripped_q) | (zero_q & ~dac_load_o);
    end
  end

  channel_strobe u_dac_stream (
    .clk_ref_i, .rst_ni,
    .start_i((phase_rise & ~(trip_i & dac_busy)) | (zero_q & ~dac_busy)),
    .ce_i(dac_ce), .mid_i(dac_mid), .fast_i(dac_fast), .word_i(dac_strobe_i),
    .busy_o(dac_busy), .load_o(dac_load_o), .shift_o(dac_shift_o), .sample_o(dac_sample), .bit_o(dac_bit),
    .clk_d_o(dac_clk_d), .fast_o(dac_runs_fast), .strobe_o(dac_strobe_o)
  );
  channel_serial_clock u_dac_clk (
    .clk_pwm_i, .rst_ni, .ref_next_i(ref_next_q), .ref_last_i(ref_last),
    .clk_d_i(dac_clk_d), .fast_i(dac_runs_fast), .clk_o(dac_clk_o)
  );
  channel_strobe u_adc_stream (
    .clk_ref_i, .rst_ni,
    .start_i(phase_rise), .ce_i(adc_ce), .mid_i(adc_mid), .fast_i(adc_fast), .word_i(adc_strobe_i),
    .busy_o(adc_busy), .load_o(adc_load), .shift_o(adc_shift), .sample_o(adc_sample_o), .bit_o(adc_bit_o),
    .clk_d_o(adc_clk_d), .fast_o(adc_runs_fast), .strobe_o(adc_strobe_o)
  );
  channel_serial_clock u_adc_clk (
    .clk_pwm_i, .rst_ni, .ref_next_i(ref_next_q), .ref_last_i(ref_last),
    .clk_d_i(adc_clk_d), .fast_i(adc_runs_fast), .clk_o(adc_clk_o)
  );

endmodule : channel_clocks

`default_nettype wire
