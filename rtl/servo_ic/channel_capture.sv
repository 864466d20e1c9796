// Position capture: one shot, triggered by the rising edge of the condition that I7mn2, I7mn3 and I7mn4 select; reading
// X:+3 arms it again, at the edge at which the read takes its sample. A capture at that edge wins.
// Clock clk_ref_i, asynchronous reset.
`default_nettype none

module channel_capture (
  input  wire logic        clk_ref_i,
  input  wire logic        rst_ni,
  input  wire logic        ce_i,            // SCLK
  input  wire logic        ready_i,
  input  wire logic        index_i,
  input  wire logic        hmfl_i,
  input  wire logic        plim_i,
  input  wire logic        mlim_i,
  input  wire logic        user_i,
  input  wire logic [2:0]  hall_i,          // W, V, U from bit 0 up
  input  wire logic [1:0]  source_i,        // I7mn2 bits 1..0
  input  wire logic        index_inv_i,     // I7mn2 bit 2, software trigger
  input  wire logic        flag_inv_i,      // I7mn2 bit 3
  input  wire logic [1:0]  flag_select_i,   // I7mn3
  input  wire logic        gated_i,         // I7mn4
  input  wire logic [23:0] counter_d_i,     // position after this edge
  input  wire logic [11:0] fraction_d_i,
  input  wire logic        read_i,          // this edge takes the sample of a read of X:+3
  output logic [23:0]      position_o,
  output logic [11:0]      fraction_o,
  output logic             captured_o,
  output logic             captured_gi_o,
  output logic [2:0]       hall_o
);

  logic        captured_q, captured_gi_q, term_q;
  logic [2:0]  hall_last_q, hall_q;
  logic [23:0] position_q;
  logic [11:0] fraction_q;

  // Gating without the index in the condition means an edge of U, V or W instead.
  logic index, flag, uses_index, hall_mode, term, trigger;
  assign index = index_i ^ index_inv_i;
  always_comb begin
    case (flag_select_i)
      brick_regs_pkg::FlagSelectHmfl: flag = hmfl_i ^ flag_inv_i;
      brick_regs_pkg::FlagSelectPlim: flag = plim_i ^ flag_inv_i;
      brick_regs_pkg::FlagSelectMlim: flag = mlim_i ^ flag_inv_i;
      brick_regs_pkg::FlagSelectUser: flag = user_i ^ flag_inv_i;
    endcase
    uses_index = 1'b0;
    case (source_i)
      brick_regs_pkg::CaptureSourceSoftware: term = index_inv_i;
      brick_regs_pkg::CaptureSourceFlag:     term = flag;
      brick_regs_pkg::CaptureSourceIndex: begin
        term       = index;
        uses_index = 1'b1;
      end
      brick_regs_pkg::CaptureSourceIndexAndFlag: begin
        term       = index & flag;
        uses_index = 1'b1;
      end
    endcase
  end
  assign hall_mode = gated_i & ~uses_index;
  assign trigger   = ce_i & ready_i & ~captured_q & (hall_mode ? hall_i != hall_last_q : term & ~term_q);

  // No reset: nothing triggers before ready_i, and that comes when all levels of one SCLK ago have come from pins.
  always_ff @(posedge clk_ref_i) begin
    if (ce_i) begin
      term_q      <= term;
      hall_last_q <= hall_i;
    end
  end

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      captured_q    <= 1'b0;
      captured_gi_q <= 1'b0;
      position_q    <= 24'd0;
      fraction_q    <= 12'd0;
      hall_q        <= 3'd0;
    end else begin
      if (trigger) begin
        captured_q    <= 1'b1;
        captured_gi_q <= gated_i & uses_index;
        position_q    <= counter_d_i;
        fraction_q    <= fraction_d_i;
        if (hall_mode) hall_q <= hall_i;
      end else if (read_i) begin
        captured_q    <= 1'b0;
        captured_gi_q <= 1'b0;
      end
    end
  end

  assign position_o    = position_q;
  assign fraction_o    = fraction_q;
  assign captured_o    = captured_q;
  assign captured_gi_o = captured_gi_q;
  assign hall_o        = hall_q;

endmodule : channel_capture

`default_nettype wire
