// Timing of the SSI channels that share a trigger and a serial clock: an accepted trigger starts a frame, whose clock
// edges it gives to all of them; after the last one's last rise the line rests for 20 us. A trigger before that is
// refused. Times are counted in periods of clk_pwm_i (two channels of a Geo PMAC) or in cycles of 100 MHz, which an
// accumulator makes of them: 15625 of 18432 edges. Asynchronous reset. docs/ssi.md, servo-ic:11.3, servo-ic:11.4.
`default_nettype none

module ssi_group (
  input  wire logic        clk_pwm_i,
  input  wire logic        rst_ni,
  input  wire logic        geo_i,      // word of a Geo PMAC, else of a Brick
  // parts of the group's word
  input  wire logic [7:0]  divisor_i,
  input  wire logic [3:0]  power_i,    // of two, another divisor
  input  wire logic        servo_i,    // the trigger is an edge of SERVO, else of PHASE
  input  wire logic        falling_i,
  input  wire logic [3:0]  delay_i,    // serial periods from trigger to first fall
  input  wire logic [3:0]  code_i,     // protocol, on a Geo PMAC clock
  input  wire logic        phase_rise_i,
  input  wire logic        phase_fall_i,
  input  wire logic        servo_rise_i,
  input  wire logic        servo_fall_i,
  input  wire logic        enabled_i,  // some channel waits for a trigger
  input  wire logic        active_i,   // some channel has not had its last rise
  // each high before the edge at which it happens
  output logic             start_o,
  output logic             refuse_o,
  output logic             fall_o,
  output logic             rise_o,
  output logic             moves_o     // with any of these
);

  localparam logic [15:0] CyclesUp = 16'd15625, CyclesOf = 16'd18432;  // 100 MHz of 117.9648 MHz
  localparam logic [23:0] LeastPeriod = 24'd25;                        // 4 MHz
  localparam logic [23:0] RestTicks = 24'd2360;                        // 20 us
  localparam logic [3:0]  Protocol = 4'h2;                             // SSI

  logic net_edge, trigger;
  assign net_edge = servo_i ? (falling_i ? servo_fall_i : servo_rise_i) : (falling_i ? phase_fall_i : phase_rise_i);
  assign trigger  = geo_i ? servo_fall_i : net_edge & (code_i == Protocol);

  //  state   clock  ends
  //  Idle    high   with a trigger
  //  Delay   high   after as many serial periods as the word says
  //  Low     low    after the low half
  //  High    high   after the high half, or at once when no channel has clocks left
  //  Rest    high   20 us after the last rise
  typedef enum logic [2:0] {Idle, Delay, Low, High, Rest} state_e;
  state_e      state_d, state_q;
  logic [15:0] cycles_d, cycles_q;
  logic [23:0] left_d, left_q;
  logic [3:0]  periods_d, periods_q;
  logic        runs;
  assign start_o  = trigger & enabled_i & (state_q == Idle);
  assign refuse_o = trigger & (state_q != Idle);
  assign runs     = start_o | (state_q != Idle);

  // The serial period, low first; an odd one is longer high. Worked out in a frame only: the rest of the time a group
  // costs a simulation little.
  logic [23:0] divided, period, low_time;
  logic [15:0] sum;
  logic [3:0]  delay;
  logic        cycle, last;
  always_comb begin
    state_d   = state_q;
    cycles_d  = cycles_q;
    left_d    = left_q;
    periods_d = periods_q;
    divided   = 24'd0;
    period    = 24'd0;
    low_time  = 24'd0;
    sum       = 16'd0;
    delay     = 4'd0;
    cycle     = 1'b0;
    last      = 1'b0;
    if (runs) begin
      divided   = {15'h0, {1'b0, divisor_i} + 9'd1} << power_i;
      period    = geo_i ? 24'd768 >> code_i[1:0] : (divided < LeastPeriod) ? LeastPeriod : divided;
      low_time  = {1'b0, period[23:1]};
      delay     = geo_i ? 4'd0 : delay_i;
      sum       = cycles_q + CyclesUp;
      cycle     = geo_i | (state_q == Rest) | (sum >= CyclesOf);
      last      = cycle & (left_q == 24'd1);
      cycles_d  = cycle ? sum - CyclesOf : sum;
      left_d    = cycle ? left_q - 24'd1 : left_q;
      case (state_q)
        Idle: begin
          cycles_d  = 16'd0;
          periods_d = delay;
          left_d    = (delay == 4'd0) ? low_time : period;
          state_d   = Low;
          if (delay != 4'd0) state_d = Delay;
        end
        Delay: if (last) begin
          periods_d = periods_q - 4'd1;
          left_d    = (periods_q == 4'd1) ? low_time : period;
          if (periods_q == 4'd1) state_d = Low;
        end
        Low: if (last) begin
          left_d  = period - low_time;
          state_d = High;
        end
        High: if (!active_i) begin
          left_d  = RestTicks - 24'd1;
          state_d = Rest;
        end else if (last) begin
          left_d  = low_time;
          state_d = Low;
        end
        default: if (last) state_d = Idle;
      endcase
    end
  end
  assign fall_o  = (state_d == Low) & (state_q != Low);
  assign rise_o  = (state_q == Low) & last;
  assign moves_o = start_o | refuse_o | fall_o | rise_o;

  always_ff @(posedge clk_pwm_i or negedge rst_ni) begin
    if (!rst_ni) begin
      state_q   <= Idle;
      cycles_q  <= 16'd0;
      left_q    <= 24'd0;
      periods_q <= 4'd0;
    end else if (runs) begin
      state_q   <= state_d;
      cycles_q  <= cycles_d;
      left_q    <= left_d;
      periods_q <= periods_d;
    end
  end

endmodule : ssi_group

`default_nettype wire
