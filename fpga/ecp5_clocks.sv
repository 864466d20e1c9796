// Both clocks from one oscillator of 39.3216 MHz: a PLL of the ECP5. VCO 589.824 MHz, /15 is clk_ref, fed back, so that
// it is in phase with the oscillator in each chip that has the same one; /5 is clk_pwm. Both dividers start at the same
// VCO edge (equal CPHASE), so each rising edge of clk_ref meets one of clk_pwm. Lock joins the reset. docs/fpga.md.
`default_nettype none

module ecp5_clocks (
  input  wire logic clk_i,       // 39.3216 MHz
  output logic      clk_pwm_o,   // 117.9648 MHz
  output logic      clk_ref_o,   // 39.3216 MHz
  output logic      locked_o
);

  (* FREQUENCY_PIN_CLKI = "39.3216", FREQUENCY_PIN_CLKOP = "117.9648", FREQUENCY_PIN_CLKOS = "39.3216",
     ICP_CURRENT = "12", LPF_RESISTOR = "8", MFG_ENABLE_FILTEROPAMP = "1", MFG_GMCREF_SEL = "2" *)
  EHXPLLL #(
    .CLKI_DIV       (1),
    .CLKFB_DIV      (1),
    .FEEDBK_PATH    ("CLKOS"),
    .CLKOP_ENABLE   ("ENABLED"),
    .CLKOP_DIV      (5),
    .CLKOP_CPHASE   (2),
    .CLKOP_FPHASE   (0),
    .CLKOS_ENABLE   ("ENABLED"),
    .CLKOS_DIV      (15),
    .CLKOS_CPHASE   (2),
    .CLKOS_FPHASE   (0),
    .PLLRST_ENA     ("DISABLED"),
    .INTFB_WAKE     ("DISABLED"),
    .STDBY_ENABLE   ("DISABLED"),
    .DPHASE_SOURCE  ("DISABLED"),
    .OUTDIVIDER_MUXA("DIVA"),
    .OUTDIVIDER_MUXB("DIVB"),
    .OUTDIVIDER_MUXC("DIVC"),
    .OUTDIVIDER_MUXD("DIVD")
  ) u_pll (
    .CLKI(clk_i), .CLKFB(clk_ref_o), .CLKOP(clk_pwm_o), .CLKOS(clk_ref_o), .LOCK(locked_o),
    .RST(1'b0), .STDBY(1'b0), .ENCLKOP(1'b0), .ENCLKOS(1'b0), .PLLWAKESYNC(1'b0),
    .PHASESEL0(1'b0), .PHASESEL1(1'b0), .PHASEDIR(1'b1), .PHASESTEP(1'b1), .PHASELOADREG(1'b1)
  );

endmodule : ecp5_clocks

`default_nettype wire
