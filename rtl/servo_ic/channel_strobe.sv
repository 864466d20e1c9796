// Common part of a serial DAC or ADC stream: 24 bits of a strobe word, bit 23 first, from the first bit clock not
// before the rising edge of PHASE. Bits change with the falling edge of the serial clock; after bit 0 the clock stops
// low and the strobe keeps its last level. Clock clk_ref_i, asynchronous reset. docs/servo_channel.md, Serial DAC and
// ADC.
`default_nettype none

module channel_strobe (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        start_i,   // PHASE rises
  input  wire logic        ce_i,      // bit clock: start and middle of a bit
  input  wire logic        mid_i,
  input  wire logic        fast_i,    // a bit is one clk_ref long
  input  wire logic [23:0] word_i,
  output logic             busy_o,
  output logic             load_o,    // this edge starts bit 23, the next bit
  output logic             shift_o,
  output logic             sample_o,  // this edge takes the received bit number bit_o (0 is the first)
  output logic [4:0]       bit_o,
  output logic             clk_d_o,   // level of the serial clock from this edge on, for one clk_pwm at least
  output logic             fast_o,    // a clock of one clk_ref runs: low for one clk_pwm, high for two
  output logic             strobe_o
);

  logic        pending_q, clk_q;
  logic [4:0]  left_q;  // bits to go, the present one included
  logic [23:0] word_q;
  logic        busy;

  assign busy     = left_q != 5'd0;
  assign busy_o   = busy;
  assign bit_o    = 5'd24 - left_q;
  assign strobe_o = word_q[23];

  always_comb begin
    load_o   = 1'b0;
    shift_o  = 1'b0;
    sample_o = 1'b0;
    clk_d_o  = 1'b0;
    fast_o   = 1'b0;
    if (ce_i) begin
      if (pending_q || start_i) load_o = 1'b1;
      else                      shift_o = busy;
    end
    if (busy) begin
      sample_o = fast_i ? ce_i : mid_i;
      clk_d_o  = ~ce_i & (mid_i | clk_q);
      fast_o   = fast_i;
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      pending_q <= 1'b0;
      clk_q     <= 1'b0;
      left_q    <= 5'd0;
      word_q    <= 24'd0;
    end else begin
      pending_q <= (pending_q | start_i) & ~ce_i;
      if (ce_i)       clk_q <= 1'b0;
      else if (mid_i) clk_q <= 1'b1;
      if (load_o) begin
        left_q <= 5'd24;
        word_q <= word_i;
      end else if (shift_o) begin
        left_q <= left_q - 5'd1;
        word_q <= {word_q[22:0], word_q[0]};
      end
    end
  end

endmodule : channel_strobe

`default_nettype wire
