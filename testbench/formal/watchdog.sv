// Rules of the watchdog's circuit, servo-ic:10/4 to servo-ic:10/7 and servo-ic:10/12, for whatever strobes, SERVO and
// the 5 V supply do. A step is one clk_ref, 25.43 ns; the times are those of the real counters, 960 periods of 1024.
// Nothing is assumed but that a run starts in reset.
// proof: induction 2
// clocks: one
// steps: 16
// fault R1: what is good again ends the trip (rtl/board/watchdog.sv)
//   - trip_d        = trip_q | ~good;
//   + trip_d        = (trip_q & ~good) | ~good;
// fault R3: the relay needs a strobe (rtl/board/watchdog.sv)
//   - relay_q       <= ~trip_d;
//   + relay_q       <= ~trip_d & strobe_i;
// fault R5: the supply trips before it has passed two flip-flops (rtl/board/watchdog.sv)
//   - trip_d        = trip_q | ~good;
//   + trip_d        = trip_q | ~good | ~pwr_good_i;
// fault R6: what waits for the trip hears of it when it is there (rtl/board/watchdog.sv)
//   - assign trip_d_o = trip_d;
//   + assign trip_d_o = trip_q;
`default_nettype none

module watchdog_rules (
  input wire logic clk_i,
  input wire logic rst_ni,
  input wire logic strobe_i,
  input wire logic servo_i,
  input wire logic good_i
);

  localparam logic [20:0] Least = 21'd959 * 21'd1024 + 21'd1;  // edges of clk_ref from a reload to the trip
  localparam logic [20:0] Most  = 21'd960 * 21'd1024;

  logic trips, trip, relay;
  watchdog dut (.clk_ref_i(clk_i), .rst_ni, .strobe_i, .servo_i, .pwr_good_i(good_i), .trip_d_o(trips), .trip_o(trip),
                .relay_o(relay));
  // From inside, for the induction: edges to the trip of either timer.
  (* hierconn *) wire logic [9:0]  \dut.prescale_q , \dut.strobe_left_q , \dut.servo_left_q ;
  (* hierconn *) wire logic        \dut.servo1_q , \dut.servo2_q ;
  (* hierconn *) wire logic        \dut.good ;
  (* hierconn *) wire logic        \dut.u_good_sync.sync1_q ;
  logic [20:0] strobe_to_go, servo_to_go;
  assign strobe_to_go = {1'b0, \dut.strobe_left_q , 10'd0} - {11'd0, \dut.prescale_q };
  assign servo_to_go  = {1'b0, \dut.servo_left_q , 10'd0} - {11'd0, \dut.prescale_q };

  // Edges since the last strobe, the last edge of SERVO, behind two flip-flops; the pins an edge and two ago.
  logic        started_q = 1'b0, trip_q = 1'b0, trips_q = 1'b0;
  logic [1:0]  servo_q, good_q, edges_q;
  logic [20:0] strobe_age_q, servo_age_q;
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) begin
      {strobe_age_q, servo_age_q} <= 42'd0;
      {servo_q, good_q}           <= 4'b1111;
      {trip_q, trips_q}           <= 2'b00;
      edges_q                     <= 2'd0;
    end else begin
      strobe_age_q <= strobe_i ? 21'd0 : strobe_age_q + 21'd1;
      servo_age_q  <= (servo_q[0] != servo_q[1]) ? 21'd0 : servo_age_q + 21'd1;
      servo_q      <= {servo_q[0], servo_i};
      good_q       <= {good_q[0], good_i};
      trip_q       <= trip;
      trips_q      <= trips;
      if (edges_q != 2'd3) edges_q <= edges_q + 2'd1;
    end
  end

  logic dead_q;  // the supply was not good at the third edge before this or earlier
  always_ff @(posedge clk_i or negedge rst_ni) begin
    if (!rst_ni) dead_q <= 1'b0;
    else         dead_q <= dead_q | ~good_q[1];
  end

  always @(posedge clk_i) begin
    started_q <= 1'b1;
    // guarantee: power-on
    assume (started_q || !rst_ni);
    if (rst_ni) begin
      // R1: A trip stays until a reset.
      if (trip_q) begin
        R1: assert (trip);
        C1: cover (good_q == 2'b11);
      end

      // R2: A supply that is not good trips at the third edge, whatever the timers say.
      if (dead_q) begin
        R2: assert (trip);
        C2: cover (!trip_q);
      end

      // R3: The relay is energised from the first edge after a reset to the trip, and not after it.
      if (edges_q != 2'd0) begin
        R3: assert (relay == !trip);
        C3: cover (relay && edges_q == 2'd3);
      end

      // R4: Without a trip neither strobe nor edge of SERVO is 960 periods of 1024 clk_ref ago, 25 ms.
      if (!trip) begin
        R4: assert (strobe_age_q < Most && servo_age_q < Most);
        C4: cover (strobe_age_q == 21'd7 && servo_age_q == 21'd4);
      end

      // R5: While strobe and edge of SERVO are less than 24.97 ms ago and the supply is good nothing trips.
      if (!trip_q && !dead_q && strobe_age_q < Least && servo_age_q < Least) begin
        R5: assert (!trip);
        C5: cover (strobe_age_q == 21'd9);
      end

      // R6: What waits for the trip hears of it an edge before.
      if (trip != trip_q) begin
        R6: assert (trip == trips_q);
        C6: cover (strobe_age_q == 21'd7);
      end

      // I1: What is to go and what has passed make 959 to 960 periods, of which the first is a part.
      if (!trip) begin
        I1: assert (strobe_to_go + strobe_age_q >= Least && strobe_to_go + strobe_age_q <= Most &&
                    servo_to_go + servo_age_q >= Least && servo_to_go + servo_age_q <= Most &&
                    strobe_to_go != 21'd0 && servo_to_go != 21'd0 && strobe_to_go <= Most && servo_to_go <= Most);
      end

      // I2: SERVO and supply inside are those of two edges ago.
      I2: assert ({\dut.servo2_q , \dut.servo1_q } == {servo_q[1], servo_q[0]} && \dut.good == good_q[1] &&
                  \dut.u_good_sync.sync1_q == good_q[0] && (!dead_q || trip));
    end
  end

endmodule : watchdog_rules

`default_nettype wire
