// The interrupt controller with the line of the host bus that it drives, as board_top joins them: what its component
// simulates. docs/components.md.
`default_nettype none

module interrupt_pins (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic       reset_i,
  input  wire logic [7:0] line_i,
  input  wire logic       wr_i,
  input  wire logic [1:0] addr_i,
  input  wire logic [7:0] wdata_i,
  output logic [7:0]      rdata_o,
  output logic [7:0]      ist_o,
  output logic [7:0]      sig_o,
  output logic [7:0]      msk_o,
  output logic [7:0]      elr_o,
  output logic            irq_o
);

  logic request, served;

  interrupt_controller u_interrupt_controller (
    .clk_ref_i, .rst_ni, .reset_i, .line_i, .wr_i, .addr_i, .wdata_i,
    .rdata_o, .ist_o, .sig_o, .msk_o, .elr_o, .request_o(request), .served_o(served)
  );
  host_interrupt u_host_interrupt (.clk_ref_i, .rst_ni, .request_i(request), .served_i(served), .irq_o);

endmodule : interrupt_pins

`default_nettype wire
