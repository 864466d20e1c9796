// Test top: the blocks of a channel that have a parameter for what the data sheet leaves open, once for each value. Bit
// or element 0 has the parameter at 0; the three ADCs drop 0, 4 and 6 bits.
`default_nettype none

module choices_bench (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,
  // compare
  input  wire logic        fine_i,
  input  wire logic        other_i,
  input  wire logic        count_i,
  input  wire logic        down_i,
  input  wire logic        still_i,
  input  wire logic [23:0] counter_i,
  input  wire logic [11:0] fraction_i,
  input  wire logic [5:0]  we_i,
  input  wire logic [23:0] wdata_i,
  output logic [1:0]       equ_o,
  output logic [23:0]      a_o[2],
  output logic [23:0]      b_o[2],
  // decode
  input  wire logic        ready_i,
  input  wire logic [3:0]  mode_i,
  input  wire logic        hold_i,
  input  wire logic [2:0]  abc_i,
  input  wire logic        pulse_i,
  input  wire logic        pulse_down_i,
  output logic [1:0]       count_o,
  output logic [1:0]       down_o,
  output logic [1:0]       error_o,
  // ADC
  input  wire logic        sample_i,
  input  wire logic [4:0]  bit_i,
  input  wire logic        phase_fall_i,
  input  wire logic        data_i,
  output logic [17:0]      value_o[3]
);

  for (genvar i = 0; i < 2; i++) begin : gen_value
    logic [23:0] inc;
    logic [11:0] a_fraction, b_fraction;
    logic        mark, echo, unused;
    channel_compare #(.EquOnLeave(i == 1)) u_compare (
      .clk_ref_i, .rst_ni, .ce_i, .fine_i, .other_i, .source_fine_i(fine_i),
      .count_i, .down_i, .still_i, .counter_i, .fraction_i,
      .we_i, .wdata_i, .trip_d_i(1'b0),
      .a_o(a_o[i]), .b_o(b_o[i]), .inc_o(inc),
      .a_fraction_o(a_fraction), .b_fraction_o(b_fraction),
      .equ_o(equ_o[i])
    );
    channel_decode #(.ALeadsUp(i == 1)) u_decode (
      .clk_ref_i, .ce_i, .ready_i, .mode_i, .hold_i,
      .abc_i, .pulse_i, .pulse_down_i,
      .count_o(count_o[i]), .down_o(down_o[i]), .error_o(error_o[i]),
      .mark_o(mark), .echo_o(echo)
    );
    assign unused = &{1'b0, inc, a_fraction, b_fraction, mark, echo};
  end

  channel_adc #(.Latency(5'd0)) u_adc_0 (
    .clk_ref_i, .rst_ni, .sample_i, .bit_i, .phase_fall_i, .data_i,
    .value_o(value_o[0])
  );
  channel_adc u_adc_4 (
    .clk_ref_i, .rst_ni, .sample_i, .bit_i, .phase_fall_i, .data_i,
    .value_o(value_o[1])
  );
  channel_adc #(.Latency(5'd6)) u_adc_6 (
    .clk_ref_i, .rst_ni, .sample_i, .bit_i, .phase_fall_i, .data_i,
    .value_o(value_o[2])
  );

endmodule : choices_bench

`default_nettype wire
