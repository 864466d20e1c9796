// Rules of an SSI group, servo-ic:11.3, servo-ic:11.4, servo-ic:11.9, for whatever word, which may change at every
// tick, and any moves of PHASE and SERVO: what starts a frame and what is refused, when the serial clock falls and
// rises, how long it rests. They are what ssi_channel.sv assumes. Of the channels is assumed what is proved there: they
// are at work from a start on, each until one of the rises.
// proof: induction 3
// clocks: one
// steps: 110
// edit: a rest of 20 ticks instead of 20 us (rtl/ssi/ssi_group.sv)
//   - RestTicks = 24'd2360
//   + RestTicks = 24'd20
// fault R1: the trigger of a Geo PMAC as a Brick's word says (rtl/ssi/ssi_group.sv)
//   - trigger  = geo_i ? servo_fall_i :
//   + trigger  =
// fault R2: no refusal in the rest (rtl/ssi/ssi_group.sv)
//   - trigger & (state_q != Idle);
//   + trigger & (state_q != Idle) & (state_q != Rest);
// fault R3: a delay of one period too many (rtl/ssi/ssi_group.sv)
//   - if (periods_q == 4'd1) state_d
//   + if (periods_q == 4'd0) state_d
// fault R4: both halves of an odd period alike (rtl/ssi/ssi_group.sv)
//   - period - low_time;
//   + low_time;
// fault R5: the longest period lacks a bit (rtl/ssi/ssi_group.sv)
//   - {1'b0, divisor_i} + 9'd1} << power_i
//   + {1'b0, divisor_i} + 9'd1} << power_i[2:0]
// fault R6: the rest a tick too long (rtl/ssi/ssi_group.sv)
//   - RestTicks - 24'd1
//   + RestTicks
// fault R7: a clock more than the channels have (rtl/ssi/ssi_group.sv)
//   - High: if (!active_i) begin
//   + High: if (1'b0) begin
`default_nettype none

module ssi_group_rules (
  input wire logic       clk_i,
  input wire logic [7:0] divisor_i,
  input wire logic [3:0] power_i,
  input wire logic       servo_i,
  input wire logic       falling_i,
  input wire logic [3:0] delay_i,
  input wire logic [3:0] code_i,
  input wire logic       phase_rise_i,
  input wire logic       phase_fall_i,
  input wire logic       servo_rise_i,
  input wire logic       servo_fall_i,
  input wire logic       enabled_i,
  input wire logic       stop_i       // the channels have no clock left
);

  logic rst_nq = 1'b0;
  always @(posedge clk_i) rst_nq <= 1'b1;

  (* anyconst *) logic geo;  // product

  logic start, refuse, fall, rise, moves;
  logic active_q = 1'b0;
  // guarantee: ssi_channel R2, a clock before: active_o
  always @(posedge clk_i) active_q <= rst_nq & (start | (active_q & ~(rise & stop_i)));
  ssi_group dut (.clk_pwm_i(clk_i), .rst_ni(rst_nq), .geo_i(geo), .divisor_i, .power_i, .servo_i, .falling_i, .delay_i,
                 .code_i, .phase_rise_i, .phase_fall_i, .servo_rise_i, .servo_fall_i, .enabled_i, .active_i(active_q),
                 .start_o(start), .refuse_o(refuse), .fall_o(fall), .rise_o(rise),
                 .moves_o(moves));

  // What the word asks for.
  logic [31:0] period, low_half;
  logic        trigger;
  always_comb begin
    period = ({24'd0, divisor_i} + 32'd1) << power_i;
    if (period < 32'd25) period = 32'd25;  // 4 MHz
    if (geo) begin
      case (code_i[1:0])
        2'd0:    period = 32'd768;  // 153.6 kHz
        2'd1:    period = 32'd384;
        2'd2:    period = 32'd192;
        default: period = 32'd96;
      endcase
    end
    low_half = period >> 1;
    case ({servo_i, falling_i})
      2'b00:   trigger = phase_rise_i;
      2'b01:   trigger = phase_fall_i;
      2'b10:   trigger = servo_rise_i;
      default: trigger = servo_fall_i;
    endcase
    if (code_i != 4'd2) trigger = 1'b0;
    if (geo) trigger = servo_fall_i;
  end

  // A frame from its trigger to the end of its rest; the clock in it. Cycles left to the clock's next edge, periods
  // before its first fall. Ticks since the last rise. `over_q` is 15625 times the ticks since the trigger less 18432
  // times the cycles that have ended: below 18432 as long as each ends at the first tick that is not before it.
  logic        run_q = 1'b0, before_q = 1'b0, low_q = 1'b0, rest_q = 1'b0, first, next, ends;
  logic [3:0]  periods_q = 4'd0;
  logic [31:0] left_q = 32'd0;
  logic [12:0] since_q = 13'd0;
  logic [15:0] over_q = 16'd0;
  logic        cycle;
  assign cycle = over_q + 16'd15625 >= 16'd18432;
  assign ends  = geo | cycle;
  assign first = before_q & ends & (left_q == 32'd1) & (periods_q == 4'd1);
  assign next  = run_q & ~before_q & ~rest_q & ends & (left_q == 32'd1);
  always @(posedge clk_i) begin
    since_q <= rise ? 13'd0 : (since_q == 13'd4096) ? since_q : since_q + 13'd1;
    if (!run_q) begin
      run_q     <= start & rst_nq;
      over_q    <= 16'd0;
      before_q  <= start & rst_nq & ~geo & (delay_i != 4'd0);
      low_q     <= start & rst_nq & (geo | (delay_i == 4'd0));
      periods_q <= delay_i;
      left_q    <= (geo | (delay_i == 4'd0)) ? low_half : period;
    end else begin
      over_q <= over_q + 16'd15625 - (cycle ? 16'd18432 : 16'd0);
      left_q <= left_q - {31'd0, ends};
      if (before_q && ends && left_q == 32'd1) begin
        periods_q <= periods_q - 4'd1;
        before_q  <= periods_q != 4'd1;
        low_q     <= periods_q == 4'd1;
        left_q    <= (periods_q == 4'd1) ? low_half : period;
      end
      if (!before_q && !rest_q && !low_q && !active_q) begin
        rest_q <= 1'b1;
      end else if (next) begin
        low_q  <= ~low_q;
        left_q <= low_q ? period - low_half : low_half;
      end
      if (rest_q && since_q == 13'd19) begin
        run_q  <= 1'b0;
        rest_q <= 1'b0;
      end
    end
  end

  // From inside.
  (* hierconn *) wire logic [2:0]  \dut.state_q ;
  (* hierconn *) wire logic [15:0] \dut.cycles_q ;
  (* hierconn *) wire logic [23:0] \dut.left_q , \dut.period ;
  (* hierconn *) wire logic [3:0]  \dut.periods_q ;

  always @(posedge clk_i) if (rst_nq) begin
    // L1: The states of the design are the frame's here.
    L1: assert (\dut.state_q == (!run_q ? 3'd0 : before_q ? 3'd1 : low_q ? 3'd2 : rest_q ? 3'd4 : 3'd3) &&
                (run_q || (!before_q && !low_q && !rest_q)) && !(before_q && low_q) &&
                !(rest_q && (before_q || low_q)) &&
                (run_q || !active_q) && (!(before_q || low_q) || active_q) && !(rest_q && active_q));

    // L2: So are its counts, in the rest of ticks.
    L2: assert (over_q < 16'd18432 && (!run_q || rest_q || (\dut.cycles_q == over_q || geo)) &&
                (!run_q || rest_q || {8'd0, \dut.left_q } == left_q) && (!before_q || \dut.periods_q == periods_q) &&
                (!rest_q || \dut.left_q + {11'd0, since_q} == 24'd20) && (!rest_q || since_q < 13'd20) &&
                (!run_q || before_q || low_q || rest_q || active_q || since_q == 13'd0) &&
                (!run_q || rest_q || left_q != 32'd0) && (!before_q || periods_q != 4'd0));

    // R1: A frame starts with the move that the word asks for, a fall of SERVO on a Geo PMAC, when nothing runs and
    //     some channel waits.
    R1: assert (start == (trigger && enabled_i && !run_q));
    C1: cover (start && !geo && servo_i && !falling_i);

    // R2: Such a move is refused from the trigger to the end of the rest, and then only.
    R2: assert (refuse == (trigger && run_q));
    C2: cover (refuse && rest_q);

    // R3: The first fall comes with the trigger, or as many periods after it as the delay says.
    if (before_q || !run_q) begin
      R3: assert (fall == (first || (start && (geo || delay_i == 4'd0))));
      C3: cover (first && delay_i == 4'd2);
    end

    // R4: From there on rises and falls take turns, each as many cycles after the one before as the half has.
    if (run_q && !before_q) begin
      R4: assert (rise == (low_q && next) && fall == (!low_q && next && active_q));
      C4: cover (rise && !geo && \dut.period == 24'd27);
    end

    // R5: A period has (M + 1) 2^N cycles, at least 25, on a Geo PMAC 768 to 96 ticks.
    if (run_q || start) begin
      R5: assert ({8'd0, \dut.period } == period);
      C5: cover (!geo && period == 32'h800000);
    end

    // R8: The channels are told whenever there is anything for them.
    R8: assert (moves == (start || refuse || fall || rise));
    C8: cover (moves);

    // R6: 20 us after the last rise, and no tick later, the next move is taken: at the 2361st tick, here the 21st.
    if (since_q == 13'd20 && $past(rest_q)) begin
      R6: assert (!run_q && (!(trigger && enabled_i) || start));
      C6: cover (start);
    end

    // R7: No fall follows when no channel has clocks left.
    if (fall && !start) begin
      R7: assert (active_q);
      C7: cover (!before_q);
    end
  end

endmodule : ssi_group_rules

`default_nettype wire
