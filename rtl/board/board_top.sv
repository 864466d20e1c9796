// The controller board: board_core and the servo ICs of ServoIcMask, bit m for IC m, m + 8 for IC m*; fitted_i says
// which of those, and of the MACRO ICs of MacroIcMask, are present at run time. docs/architecture.md has the map.
`default_nettype none

module board_top #(
  parameter logic [17:0] ServoIcMask = 18'h00003,
  parameter logic [3:0]  MacroIcMask = 4'h0
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
  // Motor side, as rtl/pins/servo_ic.pins has it, for each servo IC that is built, lowest bit of ServoIcMask first;
  // without any one bit, unused.
  input  wire logic [(ServoIcMask == 0 ? 1 : motor_pins_pkg::Stride*$countones(ServoIcMask))-1:0] motor_i,
  output logic [(ServoIcMask == 0 ? 1 : motor_pins_pkg::Stride*$countones(ServoIcMask))-1:0]      motor_o,
  // clocks, host signals, watchdog, interrupt controller as seen from outside
  output logic             phase_o,
  output logic             servo_o,
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
  output logic [7:0]       pic_elr_o
);

  logic        rst_ni, rst_ref_n, trip_d;
  logic [17:0] ic_sel, ic_phase, ic_servo, ic_phase_oe, ic_servo_oe;
  logic        bus_x, bus_we, bus_rd;
  logic [4:0]  bus_addr;
  logic [23:0] bus_wdata, rdata;
  logic [18*24-1:0] ic_rdata;  // 0 of each that is not selected
  logic [71:0] equ;  // EQU of channels 1..4 of each servo IC
  logic        phase_oe, servo_oe;

  for (genvar i = 0; i < 18; i++) begin : gen_servo_ic
    if (ServoIcMask[i]) begin : gen_built
      // Its first bit there.
      localparam integer Motor = motor_pins_pkg::Stride * $countones(ServoIcMask & ((18'd1 << i) - 18'd1));
      servo_ic u_servo_ic (
        .clk_pwm_i, .clk_ref_i, .rst_ni,
        .sel_i       (ic_sel[i]),
        .x_i         (bus_x),
        .addr_i      (bus_addr),
        .we_i        (bus_we),
        .wdata_i     (bus_wdata),
        .rd_i        (bus_rd),
        .rdata_o     (ic_rdata[24*i+:24]),
        .phase_i     (phase_o),
        .servo_i     (servo_o),
        .phase_o     (ic_phase[i]),
        .servo_o     (ic_servo[i]),
        .phase_oe_o  (ic_phase_oe[i]),
        .servo_oe_o  (ic_servo_oe[i]),
        .trip_i      (wd_tripped_o),
        .trip_d_i    (trip_d),
        .pins_i      (motor_i[Motor + motor_pins_pkg::PinsLsb +: motor_pins_pkg::PinsWidth]),
        .adc_a_i     (motor_i[Motor + motor_pins_pkg::AdcALsb +: motor_pins_pkg::AdcAWidth]),
        .adc_b_i     (motor_i[Motor + motor_pins_pkg::AdcBLsb +: motor_pins_pkg::AdcBWidth]),
        .equ_o       (equ[4*i+:4]),
        .motor_o     (motor_o[Motor +: motor_pins_pkg::Stride])
      );
      logic unused_in;
      assign unused_in = &{1'b0, motor_i[Motor + motor_pins_pkg::InBits +: motor_pins_pkg::Stride -
                                         motor_pins_pkg::InBits]};
    end else begin : gen_absent
      assign ic_rdata[24*i+:24] = 24'h0;
      assign ic_phase[i]        = 1'b1;
      assign ic_servo[i]        = 1'b1;
      assign ic_phase_oe[i]     = 1'b0;
      assign ic_servo_oe[i]     = 1'b0;
      assign equ[4*i+:4]        = 4'h0;
    end
  end
  if (ServoIcMask == 0) begin : gen_no_motors
    logic unused_in;
    assign unused_in = &{1'b0, motor_i};
    assign motor_o   = 1'b0;
  end

  always_comb begin
    rdata = 24'h0;
    for (int unsigned i = 0; i < 18; i++) begin
      if (ServoIcMask[i]) rdata = rdata | ic_rdata[24*i+:24];
    end
  end

  board_core #(.ServoIcMask(ServoIcMask), .MacroIcMask(MacroIcMask)) u_core (
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
    .phase_i       (phase_o),
    .servo_i       (servo_o),
    .phase_o, .servo_o,
    .phase_oe_o    (phase_oe),
    .servo_oe_o    (servo_oe),
    .rst_no        (rst_ni),
    .rst_ref_no    (rst_ref_n),
    .trip_d_o      (trip_d),
    .ic_sel_o      (ic_sel),
    .bus_x_o       (bus_x),
    .bus_addr_o    (bus_addr),
    .bus_we_o      (bus_we),
    .bus_rd_o      (bus_rd),
    .bus_wdata_o   (bus_wdata),
    .ic_rdata_i    (rdata),
    .ic_phase_i    (ic_phase),
    .ic_servo_i    (ic_servo),
    .ic_phase_oe_i (ic_phase_oe),
    .ic_servo_oe_i (ic_servo_oe),
    .equ_i         (equ[7:0])
  );
  // Only chips need the enables and that reset; ICs that are not built have no use for the bus.
  logic unused_core;
  assign unused_core = &{1'b0, rst_ni, rst_ref_n, trip_d, ic_sel, bus_x, bus_addr, bus_we, bus_rd, bus_wdata, phase_oe,
                         servo_oe, equ[71:8]};

endmodule : board_top

`default_nettype wire
