// The board without servo ICs in a Lattice ECP5 (LFE5U-85F-8BG756C): board_chip between real pads; chips of servo ICs,
// servo_ic_chip_ecp5, stand beside it. Pads are as in brick_ecp5, but for PHASE and SERVO, which go both ways, straps
// and EQU of the servo ICs and the reset for them. docs/chips.md.
`default_nettype none

module board_chip_ecp5 (
  input  wire logic        clk_i,
  input  wire logic        rst_ni,
  // Port A of the CPU
  input  wire logic [18:0] pa_addr_i,
  input  wire logic        pa_x_i,
  input  wire logic [3:0]  pa_aa_i,
  input  wire logic        pa_int_i,
  input  wire logic        pa_rd_ni,
  input  wire logic        pa_wr_ni,
  inout  wire  [23:0]      pa_data_io,
  output logic             pa_ta_n_o,
  output logic             irq_host_o,
  // ISA
  input  wire logic [6:0]  isa_la_i,
  input  wire logic [19:0] isa_sa_i,
  input  wire logic        isa_ior_ni,
  input  wire logic        isa_iow_ni,
  input  wire logic        isa_memr_ni,
  input  wire logic        isa_memw_ni,
  input  wire logic        isa_aen_i,
  input  wire logic        isa_sbhe_ni,
  input  wire logic        isa_resetdrv_i,
  inout  wire  [15:0]      isa_sd_io,
  inout  wire              isa_iochrdy_io,
  inout  wire              isa_memcs16_n_io,
  output logic             isa_irq_o,
  // jumpers, external clocks, control panel
  input  wire logic [17:0] fitted_i,  // servo ICs
  input  wire logic        dpram_small_i,
  input  wire logic        jpan_fitted_i,
  input  wire logic [11:0] line_select_i,
  input  wire logic        pic_8259_i,
  input  wire logic [7:0]  io_base_i,
  input  wire logic        io_decode16_i,
  input  wire logic [9:0]  window_i,
  input  wire logic        window_flat_i,
  input  wire logic        slot8_i,
  input  wire logic        ext_clock_i,
  input  wire logic        ext_phase_i,
  input  wire logic        ext_servo_i,
  input  wire logic        pwr_good_i,
  input  wire logic [15:0] jpan_i,
  input  wire logic        mi1_i,
  input  wire logic        mi2_i,
  input  wire logic        axexp0_i,
  input  wire logic        axexp1_i,
  // chips of the servo ICs
  output logic             rst_ref_no,
  inout  wire              phase_io,
  inout  wire              servo_io,
  input  wire logic [7:0]  equ_i,
  // signals, watchdog; wdo_o is the trip of the servo ICs
  output logic             wdo_o,
  output logic             wd_relay_o,
  output logic             wd_led_o,
  output logic             brld_n_o,
  output logic             erld_n_o,
  output logic             f1ld_n_o,
  output logic             ipld_n_o
);

  logic clk_pwm, clk_ref, locked;
  ecp5_clocks u_clocks (.clk_i, .clk_pwm_o(clk_pwm), .clk_ref_o(clk_ref), .locked_o(locked));

  logic [23:0] pa_wdata, pa_data;
  logic [15:0] isa_wdata, isa_data;
  logic        pa_oe, iochrdy, memcs16_n, phase, phase_q, phase_oe, servo, servo_q, servo_oe;
  logic [1:0]  isa_oe;
  logic [1:0]  unused_line;
  ecp5_data_pads u_data (.pad_io(pa_data_io), .d_i(pa_data), .oe_i(pa_oe), .rd_ni(pa_rd_ni), .q_o(pa_wdata));
  for (genvar i = 0; i < 2; i++) begin : gen_isa_sd  // each byte lane
    ecp5_pads #(.Width(8)) u_isa_sd (
      .pad_io(isa_sd_io[8*i+:8]), .d_i(isa_data[8*i+:8]), .oe_i(isa_oe[i]), .q_o(isa_wdata[8*i+:8])
    );
  end
  ecp5_pads u_iochrdy (.pad_io(isa_iochrdy_io), .d_i(1'b0), .oe_i(~iochrdy), .q_o(unused_line[0]));
  ecp5_pads u_memcs16 (.pad_io(isa_memcs16_n_io), .d_i(1'b0), .oe_i(~memcs16_n), .q_o(unused_line[1]));
  ecp5_pads u_phase   (.pad_io(phase_io), .d_i(phase_q), .oe_i(phase_oe), .q_o(phase));
  ecp5_pads u_servo   (.pad_io(servo_io), .d_i(servo_q), .oe_i(servo_oe), .q_o(servo));

  board_chip #(.MacroIcMask(4'h0)) u_chip (
    .clk_pwm_i         (clk_pwm),
    .clk_ref_i         (clk_ref),
    .rst_pin_ni        (rst_ni & locked),
    .pa_addr_i, .pa_x_i, .pa_aa_i, .pa_int_i, .pa_rd_ni, .pa_wr_ni,
    .pa_wdata_i        (pa_wdata),
    .pa_data_o         (pa_data),
    .pa_data_oe_o      (pa_oe),
    .pa_ta_n_o, .irq_host_o,
    .isa_la_i, .isa_sa_i, .isa_resetdrv_i,
    .isa_sd_i          (isa_wdata),
    .isa_ior_ni, .isa_iow_ni, .isa_memr_ni, .isa_memw_ni, .isa_aen_i, .isa_sbhe_ni,
    .isa_sd_o          (isa_data),
    .isa_sd_oe_o       (isa_oe),
    .isa_iochrdy_o     (iochrdy),
    .isa_memcs16_n_o   (memcs16_n),
    .isa_irq_o,
    .fitted_i          ({4'h0, fitted_i}),
    .macro_gate_i      (4'h0),
    .dpram_small_i, .jpan_fitted_i, .line_select_i, .pic_8259_i, .io_base_i, .io_decode16_i, .window_i, .window_flat_i,
    .slot8_i, .ext_clock_i, .ext_phase_i, .ext_servo_i, .pwr_good_i, .jpan_i, .mi1_i, .mi2_i, .axexp0_i, .axexp1_i,
    .ssi_kind_i        (2'd0),  // no serial encoder inputs: their pads are for a product that has them
    .ssi_data_i        (8'hFF),
    .wdo_o, .wd_relay_o, .wd_led_o, .brld_n_o, .erld_n_o, .f1ld_n_o, .ipld_n_o,
    .phase_i           (phase),
    .servo_i           (servo),
    .phase_o           (phase_q),
    .servo_o           (servo_q),
    .phase_oe_o        (phase_oe),
    .servo_oe_o        (servo_oe),
    .rst_ref_no, .equ_i
  );

endmodule : board_chip_ecp5

`default_nettype wire
