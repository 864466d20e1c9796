// D of Port A: pads of two ways that /RD itself ends, by a gate beside each eight, sooner than through the flip-flops
// that it clears (host-bus:2.6/5); these are off before it falls again (host-bus:2.2, row 113). The gates are cells of
// their own, so that none is merged.
`default_nettype none

module ecp5_data_pads (
  inout  wire              [23:0] pad_io,
  input  wire logic        [23:0] d_i,
  input  wire logic        oe_i,
  input  wire logic        rd_ni,
  output logic             [23:0] q_o
);

  for (genvar i = 0; i < 3; i++) begin : gen_byte
    logic off;
    LUT4 #(.INIT(16'hDDDD)) u_gate (.A(oe_i), .B(rd_ni), .C(1'b0), .D(1'b0), .Z(off));  // not A, or B
    ecp5_pads #(.Width(8)) u_pa_data (.pad_io(pad_io[8*i+:8]), .d_i(d_i[8*i+:8]), .oe_i(~off), .q_o(q_o[8*i+:8]));
  end

endmodule : ecp5_data_pads

`default_nettype wire
