// Serial data of one ADC: of the 24 bits of a stream the first Latency are dropped, the next 18 are the value. It is
// handed over at the falling edge of PHASE. Clock clk_ref_i, asynchronous reset. docs/servo_channel.md, Serial DAC and
// ADC.
`default_nettype none

module channel_adc #(
  parameter logic [4:0] Latency = 5'd4  // 0..6
) (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        sample_i,
  input  wire logic [4:0]  bit_i,
  input  wire logic        phase_fall_i,
  input  wire logic        data_i,
  output logic [17:0]      value_o
);

  logic [17:0] word_q, value_q;
  logic [4:0]  place;  // in the value, 0..17
  assign place = bit_i - Latency;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      word_q  <= 18'd0;
      value_q <= 18'd0;
    end else begin
      if (sample_i && place < 5'd18) word_q <= {word_q[16:0], data_i};
      if (phase_fall_i) value_q <= word_q;
    end
  end
  assign value_o = value_q;

endmodule : channel_adc

`default_nettype wire
