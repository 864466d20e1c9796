// The board without servo ICs as a chip of its own on a board of chips: board_core between its pins, PHASE and SERVO as
// pins of two ways, EQU of servo ICs 0 and 1 as inputs, the reset for the chips of the servo ICs, let go in step with
// clk_ref. A servo IC whose strap is fitted answers reads itself; for others this chip drives 0. phase_source_o and
// source_conflict_o know MACRO ICs and jumper E1 alone. Pads are the vendor's: in, out and enable of those of two ways
// stand apart here. docs/chips.md.
`default_nettype none

module board_chip #(
  parameter logic [3:0] MacroIcMask = 4'h0
) (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_pin_ni,
  // Port A
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  input  wire logic [23:0] pa_wdata_i,
  output logic [23:0]      pa_data_o,
  output logic             pa_data_oe_o,
  output logic             pa_ta_n_o,
  output logic             irq_host_o,
  // ISA; SD is driven for each byte lane, IOCHRDY and MEMCS16# are open collector: 0 pulls, 1 lets go
  input  wire logic [6:0]  isa_la_i,  // LA[23:17]
  input  wire logic [19:0] isa_sa_i,
  input  wire logic [15:0] isa_sd_i,
  input  wire logic        isa_ior_ni,
  input  wire logic        isa_iow_ni,
  input  wire logic        isa_memr_ni,
  input  wire logic        isa_memw_ni,
  input  wire logic        isa_aen_i,
  input  wire logic        isa_sbhe_ni,
  input  wire logic        isa_resetdrv_i,
  output logic [15:0]      isa_sd_o,
  output logic [1:0]       isa_sd_oe_o,
  output logic             isa_iochrdy_o,
  output logic             isa_memcs16_n_o,
  output logic             isa_irq_o,
  // straps and external clocks
  input  wire logic [21:0] fitted_i,
  input  wire logic [3:0]  macro_gate_i,
  input  wire logic        dpram_small_i,  // 8192 words, not 32768
  input  wire logic        jpan_fitted_i,
  // Sources of IR5 (3..0), IR6, IR7: 0 none, 1..8 EQU1..EQU8, 9 WDO, 10 CTRL0, 11 CTRL1, 12 MI1, 13 MI2, 14 AXEXP0,
  // 15 AXEXP1
  input  wire logic [11:0] line_select_i,
  input  wire logic        pic_8259_i,     // the interrupt controller is an 8259
  input  wire logic [1:0]  ssi_kind_i,     // serial encoder inputs: 0 none, 1 Geo PMAC, 2 Geo Brick LV, 3 page alone
  input  wire logic [7:0]  io_base_i,      // A11..A4 of the host's I/O block
  input  wire logic        io_decode16_i,
  input  wire logic [9:0]  window_i,       // A23..A14 of the host's memory window
  input  wire logic        window_flat_i,
  input  wire logic        slot8_i,
  input  wire logic        ext_clock_i,
  input  wire logic        ext_phase_i,
  input  wire logic        ext_servo_i,
  input  wire logic        pwr_good_i,  // 5 V is good
  input  wire logic [15:0] jpan_i,  // control panel inputs, low-true
  input  wire logic        mi1_i,   // machine inputs of JOPTO
  input  wire logic        mi2_i,
  input  wire logic        axexp0_i,  // interrupt lines of an axis expansion board
  input  wire logic        axexp1_i,
  input  wire logic [7:0]  ssi_data_i,  // absolute encoders, channel 1 in bit 0
  // clocks, host signals, watchdog, interrupt controller as seen from outside
  output logic             breq_o,
  output logic             ipos_o,
  output logic             eror_o,
  output logic             f1er_o,
  output logic             hreq_o,
  output logic             port_txde_o,
  output logic             port_rxdf_o,
  output logic             wdo_o,
  output logic             wd_tripped_o,
  output logic             wd_relay_o,      // energised
  output logic             wd_led_o,
  output logic             busy_host_o,
  output logic             busy_cpu_o,
  output logic [4:0]       phase_source_o,
  output logic             source_conflict_o,
  output logic             brld_n_o,  // lamps of the control panel
  output logic             erld_n_o,
  output logic             f1ld_n_o,
  output logic             ipld_n_o,
  output logic [1:0]       ctrl_o,
  output logic [7:0]       ssi_clk_o,
  output logic [7:0]       pic_ist_o,
  output logic [7:0]       pic_sig_o,
  output logic [7:0]       pic_msk_o,
  output logic [7:0]       pic_elr_o,
  // PHASE and SERVO, driven where a MACRO IC or jumper E1 does
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,
  output logic             servo_oe_o,
  // chips of the servo ICs
  output logic             rst_ref_no,
  input  wire logic [7:0]  equ_i  // EQU1 to EQU4 of servo IC 0, of servo IC 1
);

  logic        unused_rst_n, unused_trip_d, unused_x, unused_we, unused_rd;
  logic [17:0] unused_sel;
  logic [4:0]  unused_addr;
  logic [23:0] unused_wdata;
  board_core #(.ServoIcMask(18'h3FFFF), .MacroIcMask(MacroIcMask), .ServoChips(1'b1)) u_core (
    .clk_pwm_i, .clk_ref_i, .rst_pin_ni,
    .pa_addr_i, .pa_x_i, .pa_aa_i, .pa_int_i, .pa_rd_ni, .pa_wr_ni, .pa_wdata_i, .pa_data_o, .pa_data_oe_o, .pa_ta_n_o,
    .irq_host_o,
    .isa_la_i, .isa_sa_i, .isa_sd_i, .isa_ior_ni, .isa_iow_ni, .isa_memr_ni, .isa_memw_ni, .isa_aen_i, .isa_sbhe_ni,
    .isa_resetdrv_i, .isa_sd_o, .isa_sd_oe_o, .isa_iochrdy_o, .isa_memcs16_n_o, .isa_irq_o,
    .fitted_i, .macro_gate_i, .dpram_small_i, .jpan_fitted_i, .line_select_i, .pic_8259_i, .ssi_kind_i, .io_base_i,
    .io_decode16_i, .window_i, .window_flat_i, .slot8_i, .ext_clock_i, .ext_phase_i, .ext_servo_i, .pwr_good_i, .jpan_i,
    .mi1_i, .mi2_i, .axexp0_i, .axexp1_i, .ssi_data_i,
    .breq_o, .ipos_o, .eror_o, .f1er_o, .hreq_o, .port_txde_o, .port_rxdf_o, .wdo_o, .wd_tripped_o, .wd_relay_o,
    .wd_led_o, .busy_host_o, .busy_cpu_o, .phase_source_o, .source_conflict_o, .brld_n_o, .erld_n_o, .f1ld_n_o,
    .ipld_n_o, .ctrl_o, .ssi_clk_o, .pic_ist_o, .pic_sig_o, .pic_msk_o, .pic_elr_o,
    .phase_i, .servo_i, .phase_o, .servo_o, .phase_oe_o, .servo_oe_o,
    .rst_no        (unused_rst_n),
    .rst_ref_no,
    .trip_d_o      (unused_trip_d),
    .ic_sel_o      (unused_sel),
    .bus_x_o       (unused_x),
    .bus_addr_o    (unused_addr),
    .bus_we_o      (unused_we),
    .bus_rd_o      (unused_rd),
    .bus_wdata_o   (unused_wdata),
    .ic_rdata_i    (24'h0),
    .ic_phase_i    (18'h3FFFF),
    .ic_servo_i    (18'h3FFFF),
    .ic_phase_oe_i (18'h0),
    .ic_servo_oe_i (18'h0),
    .equ_i
  );
  logic unused;
  assign unused = &{1'b0, unused_rst_n, unused_trip_d, unused_sel, unused_x, unused_addr, unused_we, unused_rd,
                    unused_wdata};

endmodule : board_chip

`default_nettype wire
