// Clock chain of a servo IC: triangle counter (MaxPhase), phase divider, servo divider, PHASE and SERVO outputs, and
// the re-alignment to an external phase clock. A pin changes its direction without a short pulse: it is released while
// both clocks are high, and taken with a rising edge of the own clock while the net is high. Clock clk_pwm_i (117.9648
// MHz), asynchronous reset. docs/clock_gen.md, servo-ic:5.1.
//
// The triangle is kept as a ramp: ramp = up ? cnt : ~cnt, which counts up in both directions from -(I+1) to I+1 (I =
// I7m00). So a turnaround is ramp == I+1, half way is ramp == -1. Both and the window around the turnaround are
// compared a tick ahead and registered: at the edge itself a few levels of logic are left.
`default_nettype none

module clock_gen (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic [14:0] max_count_i,   // I7m00; a register is in use from the second edge after its own on
  input  wire logic [3:0]  phase_div_i,   // I7m01
  input  wire logic [3:0]  servo_div_i,   // I7m02
  input  wire logic        phase_ext_i,   // I7m07 bit 0: the PHASE pin is an input
  input  wire logic        servo_ext_i,   // I7m07 bit 1: the SERVO pin is an input
  input  wire logic        phase_i,
  input  wire logic        servo_i,
  output logic             phase_o,       // own phase clock; high while external
  output logic             servo_o,
  output logic             phase_oe_o,    // the pin is driven
  output logic             servo_oe_o,
  output logic [16:0]      cnt_o,         // triangle counter, signed
  output logic             turn_o,        // this edge leaves a turnaround
  output logic             phase_rise_o,  // this edge raises, lowers the phase clock, lowers the servo clock
  output logic             phase_fall_o,
  output logic             servo_fall_o
);

  localparam logic [14:0] MaxCountReset =
      brick_regs_pkg::ServoIcPwmControlReset[brick_regs_pkg::ServoIcPwmControlMaxCountLsb +: 15];
  localparam logic [3:0] PhaseDivReset =
      brick_regs_pkg::ServoIcClockControlReset[brick_regs_pkg::ServoIcClockControlPhaseDividerLsb +: 4];
  localparam logic [3:0] ServoDivReset =
      brick_regs_pkg::ServoIcClockControlReset[brick_regs_pkg::ServoIcClockControlServoDividerLsb +: 4];
  localparam logic [16:0] Window = 17'd8;   // clk in which a turnaround follows the external edge at once
  localparam logic [1:0] MissLimit = 2'd3;  // the fourth edge in a row outside the window forces it

  logic [16:0] ramp_d, ramp_q;
  logic [14:0] max_q;                     // I of the running half triangle
  logic [16:0] close_from_q;              // I - Window: from this ramp on the coming turnaround is in the window next
  logic [16:0] recent_to_q;               // Window - 2 - I: below this ramp the last one is, next
  logic [15:0] larger_q;                  // I + Window: an I from this on is far larger
  logic        up_q;
  logic        at_top_d, at_top_q, at_middle_d, at_middle_q;
  logic        close_d, close_q;          // the coming turnaround is in the window
  logic        recent_d, recent_q;        // the last one is in the window
  logic [3:0]  phase_cnt_d, phase_cnt_q;  // turnarounds to the next phase tick
  logic [3:0]  fall_cnt_d, fall_cnt_q;    // turnarounds to the middle of the phase period
  logic        odd_d, odd_q;              // odd number of half triangles a period: PHASE falls half way up or down
  logic [3:0]  servo_cnt_d, servo_cnt_q;  // phase periods to the next servo tick
  logic [1:0]  miss_d, miss_q;
  logic        phase_d, phase_q, servo_d, servo_q;
  logic        phase_oe_q, servo_oe_q;
  logic        phase_ext, servo_ext;      // the pin is followed: a pin still driven is not
  logic        phase_pin, servo_pin;      // pins behind their synchronisers

  sync2 #(.Reset(1'b1)) u_phase_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(phase_i), .q_o(phase_pin));
  sync2 #(.Reset(1'b1)) u_servo_sync (.clk_i(clk_pwm_i), .rst_ni, .d_i(servo_i), .q_o(servo_pin));

  // The registers of the IC, again on clk_pwm_i: they stand far away and each is looked at in many places.
  logic [14:0] max_count_q;
  logic [3:0]  phase_div_q, servo_div_q;
  logic        phase_ext_q, servo_ext_q;
  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      max_count_q <= MaxCountReset;
      phase_div_q <= PhaseDivReset;
      servo_div_q <= ServoDivReset;
      phase_ext_q <= 1'b1;
      servo_ext_q <= 1'b1;
    end else begin
      max_count_q <= max_count_i;
      phase_div_q <= phase_div_i;
      servo_div_q <= servo_div_i;
      phase_ext_q <= phase_ext_i;
      servo_ext_q <= servo_ext_i;
    end
  end

  // Every other tick is just one more step of the ramp. Of an IC that follows a pin no edge is told apart here: that
  // would be the longest path there is.
  logic ext_rise, phase_release, servo_release, special, turn, retard;
  assign phase_ext = phase_ext_q & ~phase_oe_q;
  assign servo_ext = servo_ext_q & ~servo_oe_q;
  assign ext_rise  = phase_ext & phase_pin & ~phase_q;
  // A pin that is to become an input goes while it is high. SERVO rises with an edge of PHASE, so PHASE waits for
  // SERVO.
  assign servo_release = servo_oe_q & servo_ext_q & servo_q;
  assign phase_release = phase_oe_q & phase_ext_q & phase_q & (servo_q | ~(servo_oe_q & servo_ext_q));
  assign special   = at_top_q | at_middle_q | phase_ext_q | servo_ext_q;

  // External rising edge: the nearest turnaround is moved to this edge, in the first half of the way the last one back,
  // in the second half the coming one forward.
  always_comb begin
    turn   = at_top_q;
    retard = 1'b0;
    miss_d = miss_q;
    if (ext_rise) begin
      if ((ramp_q[16] ? recent_q : close_q) || miss_q == MissLimit) begin
        miss_d = 2'd0;
        turn   = at_top_q | ~ramp_q[16];
        retard = ramp_q[16];
      end else begin
        miss_d = miss_q + 2'd1;
      end
    end
  end

  // Triangle: a way is 2 I + 3 ticks, and -(I + 1) is ~I. A new maximum count is taken at the bottom turnaround.
  always_comb begin
    ramp_d      = ramp_q + 17'd1;
    at_top_d    = ramp_q == {2'b00, max_q};
    at_middle_d = &ramp_q[16:1] & ~ramp_q[0];
    close_d     = $signed(ramp_q) >= $signed(close_from_q);
    recent_d    = $signed(ramp_q) < $signed(recent_to_q);
    if (turn || retard) begin
      ramp_d      = ~{2'b00, max_q};
      at_top_d    = 1'b0;
      at_middle_d = max_q == 15'd0;
      recent_d    = up_q | ~turn | ({1'b0, max_count_q} < larger_q);  // not with a new I far larger
    end
  end

  // Phase clock. While external, PHASE follows the pin and the divider is kept ready for a full period. Only then does
  // a turnaround come from outside.
  always_comb begin
    phase_d     = phase_q;
    phase_cnt_d = phase_cnt_q;
    fall_cnt_d  = fall_cnt_q;
    odd_d       = odd_q;
    if (!special) begin
      // nothing
    end else if (phase_ext) begin
      phase_d     = phase_pin;
      phase_cnt_d = phase_div_q;
      fall_cnt_d  = 4'd0;
      odd_d       = 1'b0;
    end else if (at_top_q) begin
      if (phase_cnt_q == 4'd0) begin
        phase_d     = 1'b1;
        phase_cnt_d = phase_div_q;
        fall_cnt_d  = {1'b0, phase_div_q[3:1]} + {3'b000, phase_div_q[0]};
        odd_d       = ~phase_div_q[0];
      end else begin
        phase_cnt_d = phase_cnt_q - 4'd1;
        if (fall_cnt_q != 4'd0) fall_cnt_d = fall_cnt_q - 4'd1;
        if (fall_cnt_q == 4'd1 && !odd_q) phase_d = 1'b0;
      end
    end else if (at_middle_q && odd_q && fall_cnt_q == 4'd0) begin
      phase_d = 1'b0;
    end
    if (phase_release) phase_d = 1'b1;  // a fall at this edge stays away from the net, so no latch may see it
  end

  // Servo clock: falls with every (I7m02+1)-th fall of the phase clock and rises with the next one, or, when it is as
  // fast as the phase clock, with the next rise.
  always_comb begin
    servo_d     = servo_q;
    servo_cnt_d = servo_cnt_q;
    if (!special) begin
      // nothing
    end else if (servo_ext) begin
      servo_d     = servo_pin;
      servo_cnt_d = servo_div_q;
    end else if (phase_q != phase_d) begin
      if (phase_d) begin
        if (servo_cnt_q == 4'd0) servo_d = 1'b1;
      end else if (servo_cnt_q == 4'd0) begin
        servo_d     = 1'b0;
        servo_cnt_d = servo_div_q;
      end else begin
        servo_d     = 1'b1;
        servo_cnt_d = servo_cnt_q - 4'd1;
      end
    end
    if (servo_release) servo_d = 1'b1;
  end

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      ramp_q      <= 17'd0;
      max_q       <= MaxCountReset;
      close_from_q <= {2'b00, MaxCountReset} - Window;
      recent_to_q <= Window - 17'd2 - {2'b00, MaxCountReset};
      larger_q    <= {1'b0, MaxCountReset} + Window[15:0];
      up_q        <= 1'b1;
      at_top_q    <= 1'b0;
      at_middle_q <= 1'b0;
      close_q     <= 1'b0;
      recent_q    <= 1'b0;
      phase_cnt_q <= 4'd0;
      fall_cnt_q  <= 4'd0;
      odd_q       <= 1'b0;
      servo_cnt_q <= ServoDivReset;
      miss_q      <= 2'd0;
      phase_q     <= 1'b1;
      servo_q     <= 1'b1;
      phase_oe_q  <= 1'b0;
      servo_oe_q  <= 1'b0;
    end else begin
      ramp_q      <= ramp_d;
      at_top_q    <= at_top_d;
      at_middle_q <= at_middle_d;
      close_q     <= close_d;
      recent_q    <= recent_d;
      if (turn) begin
        up_q <= ~up_q;
        if (!up_q) begin
          max_q    <= max_count_q;
          close_from_q <= {2'b00, max_count_q} - Window;
          recent_to_q  <= Window - 17'd2 - {2'b00, max_count_q};
          larger_q     <= {1'b0, max_count_q} + Window[15:0];
        end
      end
      if (special) begin
        phase_cnt_q <= phase_cnt_d;
        fall_cnt_q  <= fall_cnt_d;
        odd_q       <= odd_d;
        servo_cnt_q <= servo_cnt_d;
        miss_q      <= miss_d;
        phase_q     <= phase_d;
        servo_q     <= servo_d;
        if (phase_release)                                           phase_oe_q <= 1'b0;
        else if (!phase_ext_q && !phase_q && phase_d && phase_pin)  phase_oe_q <= 1'b1;
        if (servo_release)                                           servo_oe_q <= 1'b0;
        else if (!servo_ext_q && !servo_q && servo_d && servo_pin)  servo_oe_q <= 1'b1;
      end
    end
  end

  assign phase_o      = phase_q | phase_ext;
  assign servo_o      = servo_q | servo_ext;
  assign phase_oe_o   = phase_oe_q;
  assign servo_oe_o   = servo_oe_q;
  assign cnt_o        = up_q ? ramp_q : ~ramp_q;
  assign turn_o       = turn;
  assign phase_rise_o = ~phase_q & phase_d;
  assign phase_fall_o = phase_q & ~phase_d;
  assign servo_fall_o = servo_q & ~servo_d;

endmodule : clock_gen

`default_nettype wire
