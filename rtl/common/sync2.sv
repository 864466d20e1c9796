// Two-flip-flop synchroniser: the only place where a level that knows nothing of clk_i may enter. The attribute tells
// placement to keep the two together and timing analysis that the first may be late; tools/check_cdc.py looks for it.
// Asynchronous reset. docs/fpga.md.
`default_nettype none

module sync2 #(
  parameter integer           Width = 1,
  parameter logic [Width-1:0] Reset = '0
) (
  input  wire logic             clk_i,
  input  wire logic             rst_ni,
  input  wire logic [Width-1:0] d_i,
  output logic [Width-1:0]      q_o
);

  (* async_reg = "true" *) logic [Width-1:0] sync1_q, sync2_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      sync1_q <= Reset;
      sync2_q <= Reset;
    end else begin
      sync1_q <= d_i;
      sync2_q <= sync1_q;
    end
  end
  assign q_o = sync2_q;

endmodule : sync2

`default_nettype wire
