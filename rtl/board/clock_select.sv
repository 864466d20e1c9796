// The board's PHASE and SERVO nets: of the ICs that drive a net the lowest-numbered wins; with no driver the net idles
// high; with jumper E1 (ext_clock_i) both come from outside. The conflict flag rises when drivers of one net have
// disagreed for more than 2 clk, and stays until there is one driver again. The choice is registered on clk_ref_i.
// External clocks pass a synchroniser on clk_pwm_i; levels of the ICs, which may stand far away, come through
// flip-flops and the nets leave through others, two clk later than an IC's own level. Asynchronous reset.
// docs/clock_select.md.
`default_nettype none

module clock_select (
  input  wire logic        clk_pwm_i,
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic [21:0] fitted_i,
  input  wire logic [21:0] phase_i,
  input  wire logic [21:0] servo_i,
  input  wire logic [21:0] phase_oe_i,
  input  wire logic [21:0] servo_oe_i,
  input  wire logic        ext_clock_i,
  input  wire logic        ext_phase_i,
  input  wire logic        ext_servo_i,
  output logic             phase_o,
  output logic             servo_o,
  output logic             phase_oe_o,      // a driver was granted; where nobody is the net idles high
  output logic             servo_oe_o,
  output logic [4:0]       phase_source_o,  // brick_regs_pkg::clock_source_e: index as in fitted_i, outside, none
  output logic             conflict_o
);

  localparam logic [1:0] Tolerated = 2'd2;  // clk for which two drivers may disagree

  logic [44:0] drivers_d, drivers_q;  // {ext, servo, phase}
  logic [21:0] phase_grant_d, phase_grant_q, servo_grant_d, servo_grant_q;
  logic        phase_idle_d, phase_idle_q, servo_idle_d, servo_idle_q;
  logic [4:0]  source_d, source_q;
  logic        several_d, several_q;  // a net has more than one driver
  assign drivers_d = {ext_clock_i, servo_oe_i & fitted_i, phase_oe_i & fitted_i};

  logic        ext;
  logic [21:0] p, s;
  always_comb begin
    {ext, s, p}   = drivers_d;
    phase_grant_d = ext ? 22'h0 : p & -p;
    servo_grant_d = ext ? 22'h0 : s & -s;
    phase_idle_d  = ~ext & (p == 22'h0);
    servo_idle_d  = ~ext & (s == 22'h0);
    several_d     = ext ? (|p | |s) : (p != (p & -p)) | (s != (s & -s));
    source_d      = ext ? brick_regs_pkg::ClockSourceOutside : brick_regs_pkg::ClockSourceNone;
    for (int unsigned i = 0; i < 22; i++) begin
      if (phase_grant_d[i]) source_d = 5'(i);
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      drivers_q     <= 45'h0;
      phase_grant_q <= 22'h0;
      servo_grant_q <= 22'h0;
      phase_idle_q  <= 1'b1;
      servo_idle_q  <= 1'b1;
      source_q      <= brick_regs_pkg::ClockSourceNone;
      several_q     <= 1'b0;
    end else begin
      drivers_q     <= drivers_d;
      phase_grant_q <= phase_grant_d;
      servo_grant_q <= servo_grant_d;
      phase_idle_q  <= phase_idle_d;
      servo_idle_q  <= servo_idle_d;
      source_q      <= source_d;
      several_q     <= several_d;
    end
  end

  logic ext_phase, ext_servo;
  sync2 #(.Reset(1'b1)) u_phase_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(ext_phase_i), .q_o(ext_phase));
  sync2 #(.Reset(1'b1)) u_servo_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(ext_servo_i), .q_o(ext_servo));

  // Drivers at different levels, which takes several.
  logic disagree, conflict_d, conflict_q;
  logic phase_q, servo_q;              // the nets
  logic phase_oe_q, servo_oe_q;
  logic [1:0] disagree_d, disagree_q;  // clk since they do
  logic [43:0] level_q;                // of the ICs, {servo, phase}
  logic [21:0] phase_low, phase_high, servo_low, servo_high;
  always_comb begin
    {servo_low, phase_low}   = 44'h0;
    {servo_high, phase_high} = 44'h0;
    disagree   = 1'b0;
    disagree_d = 2'd0;
    conflict_d = 1'b0;
    if (several_q) begin
      {servo_low, phase_low}   = drivers_q[43:0] & ~level_q;
      {servo_high, phase_high} = drivers_q[43:0] & level_q;
      if (drivers_q[44]) disagree = (ext_phase ? |phase_low : |phase_high) | (ext_servo ? |servo_low : |servo_high);
      else               disagree = (|phase_low & |phase_high) | (|servo_low & |servo_high);
      if (disagree) disagree_d = (disagree_q == Tolerated) ? Tolerated : disagree_q + 2'd1;
      conflict_d = conflict_q | (disagree & (disagree_q == Tolerated));
    end
  end

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      level_q    <= '1;
      disagree_q <= 2'd0;
      conflict_q <= 1'b0;
      phase_q    <= 1'b1;
      servo_q    <= 1'b1;
      phase_oe_q <= 1'b0;
      servo_oe_q <= 1'b0;
    end else begin
      level_q    <= {servo_i, phase_i};
      disagree_q <= disagree_d;
      conflict_q <= conflict_d;
      phase_q    <= phase_idle_q | (drivers_q[44] & ext_phase) | (|(phase_grant_q & level_q[21:0]));
      servo_q    <= servo_idle_q | (drivers_q[44] & ext_servo) | (|(servo_grant_q & level_q[43:22]));
      phase_oe_q <= ~phase_idle_q;
      servo_oe_q <= ~servo_idle_q;
    end
  end

  assign phase_o        = phase_q;
  assign servo_o        = servo_q;
  assign phase_oe_o     = phase_oe_q;
  assign servo_oe_o     = servo_oe_q;
  assign phase_source_o = source_q;
  assign conflict_o     = conflict_q & several_q;

endmodule : clock_select

`default_nettype wire
