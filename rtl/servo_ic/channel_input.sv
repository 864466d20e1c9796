// Input filter of a channel: three samples at SCLK and their majority. A pulse shorter than one SCLK period never
// passes, a level seen by two samples in a row always does. Clock clk_ref_i, asynchronous reset. Bit order is that of
// status bits 23..12.
`default_nettype none

module channel_input (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,     // SCLK
  input  wire logic [11:0] pins_i,   // behind the synchroniser
  output logic [11:0]      level_o,  // filtered
  output logic             ready_o   // all levels, also those of one SCLK ago, have come from pins
);

  logic [11:0] s0_q, s1_q, level_q;
  logic [3:0]  filled_q;

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      s0_q     <= 12'd0;
      s1_q     <= 12'd0;
      level_q  <= 12'd0;
      filled_q <= 4'd0;
    end else if (ce_i) begin
      s0_q     <= pins_i;
      s1_q     <= s0_q;
      level_q  <= (pins_i & s0_q) | (pins_i & s1_q) | (s0_q & s1_q);  // of the last three samples, this one included
      filled_q <= {filled_q[2:0], 1'b1};
    end
  end

  // The first of the samples may be a reset value of the synchroniser; three more follow it.
  logic ready_q;
  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni)                   ready_q <= 1'b0;
    else if (ce_i && filled_q[3])  ready_q <= 1'b1;
  end

  assign level_o = level_q;
  assign ready_o = ready_q;

endmodule : channel_input

`default_nettype wire
