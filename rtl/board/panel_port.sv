// Control panel port JPAN of Turbo PMAC boards: sixteen asynchronous low-true inputs through two flip-flops on
// clk_ref_i, so that the firmware never reads a level that is just changing, and the lamps of the host signals, lit by
// a low level; dark where no panel is fitted. Reset: nothing pulled low. docs/boards.md.
`default_nettype none

module panel_port (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  // JOG-, JOG+, PREJ, STRT, STEP, STOP, HOME, HOLD, FPD0..FPD3 from bit 0 up; 15..12 spare
  input  wire logic [15:0] jpan_i,
  output logic [15:0]      rdata_o,
  input  wire logic        fitted_i,
  input  wire logic        breq_i,
  input  wire logic        eror_i,
  input  wire logic        f1er_i,
  input  wire logic        ipos_i,
  output logic             brld_no,
  output logic             erld_no,
  output logic             f1ld_no,
  output logic             ipld_no
);

  sync2 #(.Width(16), .Reset(16'hFFFF)) u_sync (.clk_i(clk_ref_i), .rst_ni, .d_i(jpan_i), .q_o(rdata_o));

  assign brld_no = ~(fitted_i & breq_i);
  assign erld_no = ~(fitted_i & eror_i);
  assign f1ld_no = ~(fitted_i & f1er_i);
  assign ipld_no = ~(fitted_i & ipos_i);

endmodule : panel_port

`default_nettype wire
