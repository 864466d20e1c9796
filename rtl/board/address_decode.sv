// Decodes the synchronised Port A address into one select per register block (docs/architecture.md, memory map): gate
// ICs in area AA1 at $078000..$07BFFF, latches in the default area at X:$070010..$070012, on-chip page by int_i, the
// control panel port at Y:$078800, serial encoder inputs at $078B20..$078B3F or in a page of their own of area AA1,
// $00FF00..$00FFFF. Combinational. What is not fitted is not selected: its words read 0.
`default_nettype none

module address_decode (
  input  wire logic [18:0] addr_i,
  input  wire logic        x_i,
  input  wire logic [3:0]  aa_i,
  input  wire logic        int_i,
  input  wire logic [21:0] fitted_i,      // servo IC 0..9, 2*..9*, MACRO IC 0..3
  input  wire logic        jpan_i,        // control panel port fitted
  input  wire logic [1:0]  ssi_i,         // serial encoder inputs: 1 Geo PMAC, 2 Geo Brick LV, 3 the page without them
  output logic             sel_any_o,     // a register region: its read data goes to the bus
  output logic             sel_int_o,     // the on-chip page
  output logic             sel_port_o,    // its half with the words of the host port
  output logic             sel_signals_o, // X:$070010 host signals
  output logic             sel_strobe_o,  // X:$070011 watchdog strobe
  output logic             sel_ctrl_o,    // X:$070012 control outputs
  output logic             sel_panel_o,   // Y:$078800 control panel port
  output logic             sel_ssi_o,     // serial encoder inputs
  output logic [21:0]      sel_ic_o
);

  // Lowest bits of the address that a region has the choice of.
  localparam int GateBits  = $clog2(brick_regs_pkg::GateIcsSize);
  localparam int LatchBits = $clog2(brick_regs_pkg::LatchesSize);
  localparam int PageBits  = $clog2(brick_regs_pkg::SsiPageSize);

  logic gate, latch, page;
  assign gate  = ~int_i & aa_i[1] & (addr_i[18:GateBits] == brick_regs_pkg::GateIcsBase[18:GateBits]);
  assign latch = ~int_i & (aa_i == 4'h0) & (addr_i[18:LatchBits] == brick_regs_pkg::LatchesBase[18:LatchBits]);
  assign page  = ~int_i & aa_i[1] & ssi_i[0] & (addr_i[18:PageBits] == brick_regs_pkg::SsiPageBase[18:PageBits]);

  // Servo ICs 0, 1: $000, $100 of the first 4 KiB word page; 2..9: $200, $300 of pages 0..3; the starred ones $20
  // above. MACRO ICs: $400 of pages 0..3, 64 words each.
  logic [3:0] ic;
  logic       servo_page, macro_page, star;
  assign star       = addr_i[5];
  assign servo_page = (addr_i[11:6] == 6'b001000 || addr_i[11:6] == 6'b001100) ||
                      (addr_i[13:5] == 9'b000000000 || addr_i[13:5] == 9'b000001000);
  assign macro_page = addr_i[11:6] == 6'b010000;
  assign ic         = addr_i[9] ? {1'b0, addr_i[13:12], addr_i[8]} + 4'd2 : {3'b000, addr_i[8]};

  always_comb begin
    sel_ic_o = 22'h0;
    if (gate && servo_page) begin
      // IC m is bit m, IC m* bit m + 8.
      sel_ic_o = (22'h1 << (star ? {1'b0, ic} + 5'd8 : {1'b0, ic})) & fitted_i;
    end
    if (gate && macro_page) begin
      sel_ic_o = (22'h1 << (5'd18 + {3'b000, addr_i[13:12]})) & fitted_i;
    end
  end

  assign sel_int_o     = int_i;
  assign sel_port_o    = int_i & (addr_i[6] == brick_regs_pkg::Hi08HcrAddr[6]);
  assign sel_signals_o = latch & x_i & (addr_i[7:0] == brick_regs_pkg::BoardLatchesHostSignalsAddr[7:0]);
  assign sel_strobe_o  = latch & x_i & (addr_i[7:0] == brick_regs_pkg::BoardLatchesWatchdogStrobeAddr[7:0]);
  assign sel_ctrl_o    = latch & x_i & (addr_i[7:0] == brick_regs_pkg::BoardLatchesControlOutputsAddr[7:0]);
  assign sel_panel_o   = gate & ~x_i & jpan_i & (addr_i[13:0] == brick_regs_pkg::JpanInputsAddr[13:0]);
  assign sel_ssi_o     = (page & ~ssi_i[1] & (addr_i[7:6] == brick_regs_pkg::SsiGeoBase[7:6])) |
                         (gate & (ssi_i == 2'd2) & (addr_i[13:5] == brick_regs_pkg::SsiBrickBase[13:5]));
  assign sel_any_o     = int_i | gate | latch | page;

endmodule : address_decode

`default_nettype wire
