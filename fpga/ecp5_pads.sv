// Bidirectional pads: driven while oe_i is high. docs/fpga.md.
`default_nettype none

module ecp5_pads #(
  parameter integer Width = 1
) (
  inout  wire  [Width-1:0]      pad_io,
  input  wire logic [Width-1:0] d_i,
  input  wire logic             oe_i,
  output logic [Width-1:0]      q_o
);

  for (genvar i = 0; i < Width; i++) begin : gen_pad
    BB u_pad (.B(pad_io[i]), .I(d_i[i]), .T(~oe_i), .O(q_o[i]));
  end

endmodule : ecp5_pads

`default_nettype wire
