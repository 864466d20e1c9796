// Rules of the address decoder, host-bus:1.1 with the bases of servo-ic:1.2, servo-ic:1.3 and servo-ic:11.3,
// servo-ic:11.4, for every address, space, area and equipment: who is selected is told by the bases, not by bits of the
// address. Combinational; nothing is assumed.
// proof: pdr
// clocks: one
// steps: 4
// fault R2: starred servo ICs answer 256 words too high (rtl/board/address_decode.sv)
//   - assign star       = addr_i[5];
//   + assign star       = addr_i[8];
// fault R7: the half with the words of the host port is not told from the other (rtl/board/address_decode.sv)
//   - assign sel_port_o    = int_i & (
//   + assign sel_port_o    = int_i | (
// fault R4: area AA1 is not looked at (rtl/board/address_decode.sv)
//   - assign gate  = ~int_i & aa_i[1] &
//   + assign gate  = ~int_i &
`default_nettype none

module address_decode_rules (
  input wire logic        clk_i,
  input wire logic [18:0] addr_i,
  input wire logic        x_i,
  input wire logic [3:0]  aa_i,
  input wire logic        int_i,
  input wire logic [21:0] fitted_i,
  input wire logic        jpan_i,
  input wire logic [1:0]  ssi_i
);

  logic        any, on_chip, port, signals, strobe, ctrl, panel, ssi;
  logic [21:0] ic;
  address_decode dut (.addr_i, .x_i, .aa_i, .int_i, .fitted_i, .jpan_i, .ssi_i, .sel_any_o(any), .sel_int_o(on_chip),
                      .sel_port_o(port), .sel_signals_o(signals), .sel_strobe_o(strobe), .sel_ctrl_o(ctrl),
                      .sel_panel_o(panel), .sel_ssi_o(ssi), .sel_ic_o(ic));

  // Any IC: its base and its words, servo-ic:1.2 and servo-ic:1.3.
  (* anyconst *) logic [4:0] n;
  logic [18:0] base;
  always_comb begin
    case (n)
      5'd0: base = 19'h78000;
      5'd1: base = 19'h78100;
      5'd2: base = 19'h78200;
      5'd3: base = 19'h78300;
      5'd4: base = 19'h79200;
      5'd5: base = 19'h79300;
      5'd6: base = 19'h7A200;
      5'd7: base = 19'h7A300;
      5'd8: base = 19'h7B200;
      5'd9: base = 19'h7B300;
      5'd10: base = 19'h78220;
      5'd11: base = 19'h78320;
      5'd12: base = 19'h79220;
      5'd13: base = 19'h79320;
      5'd14: base = 19'h7A220;
      5'd15: base = 19'h7A320;
      5'd16: base = 19'h7B220;
      5'd17: base = 19'h7B320;
      5'd18: base = 19'h78400;
      5'd19: base = 19'h79400;
      5'd20: base = 19'h7A400;
      default: base = 19'h7B400;
    endcase
  end
  logic [18:0] words;
  logic        gates, latches, page;
  assign words   = (n < 5'd18) ? 19'd32 : 19'd64;
  assign gates   = !int_i && aa_i[1] && addr_i >= 19'h78000 && addr_i <= 19'h7BFFF;
  assign latches = !int_i && aa_i == 4'h0 && addr_i >= 19'h70000 && addr_i <= 19'h700FF;
  assign page    = !int_i && aa_i[1] && ssi_i[0] && addr_i >= 19'h0FF00 && addr_i <= 19'h0FFFF;

  always @(posedge clk_i) begin
    // R1: At most one block is selected, and one only in a region of the board's own.
    R1: assert ({5'd0, on_chip} + {5'd0, signals} + {5'd0, strobe} + {5'd0, ctrl} + {5'd0, panel} + {5'd0, ssi} +
                {5'd0, ic != 22'h0} <= 6'd1 && (ic & (ic - 22'h1)) == 22'h0 &&
                (any || !(on_chip || signals || strobe || ctrl || panel || ssi || ic != 22'h0)));
    C1: cover (panel);

    // R2: An IC is selected at its words from its base on, in both spaces, if it is fitted, and nowhere else.
    if (n < 5'd22) begin
      R2: assert (ic[n] == (gates && fitted_i[n] && addr_i >= base && addr_i < base + words));
      C2: cover (n == 5'd17 && ic[n]);
    end

    // R3: The latches are X words of the default area: host signals, watchdog strobe, control outputs.
    R3: assert (signals == (latches && x_i && addr_i == 19'h70010) &&
                strobe == (latches && x_i && addr_i == 19'h70011) &&
                ctrl == (latches && x_i && addr_i == 19'h70012));
    C3: cover (ctrl);

    // R4: The regions are the on-chip page, gate ICs in AA1, latches in the default area and the page of a Geo PMAC in
    // AA1.
    R4: assert (any == (int_i || gates || latches || page) && on_chip == int_i);
    C4: cover (any && page && !ssi);

    // R5: The control panel port is Y:$078800, if it is fitted.
    R5: assert (panel == (gates && jpan_i && !x_i && addr_i == 19'h78800));
    C5: cover (panel && fitted_i == 22'h0);

    // R6: Serial encoders are $078B20 to $078B3F of a Brick, $FF40 to $FF7F of the page of a Geo PMAC.
    R6: assert (ssi == ((gates && ssi_i == 2'd2 && addr_i >= 19'h78B20 && addr_i <= 19'h78B3F) ||
                        (page && ssi_i == 2'd1 && addr_i >= 19'h0FF40 && addr_i <= 19'h0FF7F)));
    C6: cover (ssi && page);

    // R7: The half with the words of the host port is X:$FFFFC0 to X:$FFFFFF of the on-chip page.
    R7: assert (port == (on_chip && addr_i[6:0] >= 7'h40));
    C7: cover (port);
  end

endmodule : address_decode_rules

`default_nettype wire
