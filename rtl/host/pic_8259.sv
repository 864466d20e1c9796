// Interrupt controller of the original PMAC PC, an 8259A alone on its lines. addr_i: 0 writes ICW1, OCW2, OCW3 and
// reads IRR, ISR or the poll byte; 1 writes ICW2 to ICW4 and OCW1 and reads IMR or the poll byte; a read of 2 is the
// acknowledge cycle and gives the vector. rd_i is high for the one clk_ref that takes rdata_o, so that what is read and
// what the read does are of one moment. Lines pass two flip-flops, INT is a third, in host_interrupt. Cascading and the
// three-byte acknowledge of 8080 systems are not built: their bits are taken without effect. Synthesis keeps it apart:
// merged with who uses served_o, the read gets into the ranks of INT. Clock clk_ref_i, asynchronous reset, after which
// nothing is enabled. docs/pic_8259.md.
`default_nettype none

(* keep_hierarchy = "true" *)
module pic_8259 (
  input  wire logic       clk_ref_i,
  input  wire logic       rst_ni,
  input  wire logic [7:0] line_i,
  input  wire logic       rd_i,
  input  wire logic       wr_i,
  input  wire logic [1:0] addr_i,
  input  wire logic [7:0] wdata_i,
  output logic [7:0]      rdata_o,
  output logic [7:0]      irr_o,
  output logic [7:0]      isr_o,
  output logic [7:0]      imr_o,
  output logic            level_o,  // 1: lines are level-sensed
  output logic            request_o,  // INT is to be high after the coming edge, unless served_o
  output logic            served_o    // a request is acknowledged
);

  // What the next write to address 1 is.
  localparam logic [1:0] StepReady = 2'd0, StepIcw2 = 2'd1, StepIcw3 = 2'd2, StepIcw4 = 2'd3;
  // Of a request that has gone, and the lowest after ICW1.
  localparam logic [2:0] DefaultLevel = brick_regs_pkg::Pic8259PollReset[2:0];
  // Addresses: several words share the first two.
  localparam logic [1:0] Command     = brick_regs_pkg::Pic8259Icw1Addr[1:0];
  localparam logic [1:0] Second      = brick_regs_pkg::Pic8259Ocw1Addr[1:0];
  localparam logic [1:0] Acknowledge = brick_regs_pkg::Pic8259VectorAddr[1:0];

  logic [7:0] line2_q;  // behind the synchroniser
  logic [7:0] armed_w, armed_d, armed_q;  // the line has been low since its last acknowledge
  logic [7:0] isr_w, isr_d, isr_q, imr_d, imr_q;
  logic [2:0] lowest_w, lowest_d, lowest_q;  // level of the lowest priority
  logic [4:0] vector_d, vector_q;
  logic [1:0] step_d, step_q;
  logic       icw3_d, icw3_q, icw4_d, icw4_q;  // will be written
  logic       level_d, level_q, aeoi_d, aeoi_q, turn_d, turn_q;  // turn: rotate at each automatic end
  logic       special_d, special_q, read_isr_d, read_isr_q, poll_d, poll_q;

  // ---------------------------------------------------------------- requests and priority
  // The set bit of the highest priority as its distance from the level above the lowest; 8: none is set.
  function automatic logic [3:0] rank(input logic [7:0] bits, input logic [2:0] lowest);
    logic [7:0] turned;
    turned = (bits >> (4'd1 + {1'b0, lowest})) | (bits << (3'd7 - lowest));
    rank   = 4'd8;
    for (int i = 7; i >= 0; i--) if (turned[i]) rank = i[3:0];
  endfunction

  logic [7:0] irr, serviced;
  logic [3:0] rank_request, rank_serviced;
  logic [2:0] level_request, level_serviced, level_ack;
  logic       pending;
  assign irr            = line2_q & (armed_q | {8{level_q}});
  assign serviced       = isr_q & ~(imr_q & {8{special_q}});  // levels that hold off others
  assign rank_request   = rank(irr & ~imr_q, lowest_q);
  assign rank_serviced  = rank(serviced, lowest_q);
  assign level_request  = rank_request[2:0] + lowest_q + 3'd1;
  assign level_serviced = rank_serviced[2:0] + lowest_q + 3'd1;
  assign pending        = (step_q == StepReady) & (rank_request < rank_serviced);
  assign level_ack      = pending ? level_request : DefaultLevel;

  // ---------------------------------------------------------------- accesses
  logic rd_poll, ack, icw1, ocw2, ocw3, second;
  assign rd_poll = rd_i & poll_q & ~addr_i[1];
  assign ack     = pending & (rd_poll | (rd_i & (addr_i == Acknowledge)));
  assign icw1    = wr_i & (addr_i == Command) & wdata_i[brick_regs_pkg::Pic8259Icw1Icw1Lsb];
  assign ocw3    = wr_i & (addr_i == Command) & ~icw1 & wdata_i[brick_regs_pkg::Pic8259Ocw3Ocw3Lsb];
  assign ocw2    = wr_i & (addr_i == Command) & ~icw1 & ~ocw3;
  assign second  = wr_i & (addr_i == Second);

  // OCW2: rotate, specific level, end of interrupt.
  logic       ocw2_turn, ocw2_specific, ocw2_end;
  logic [2:0] ocw2_level;
  assign ocw2_turn     = wdata_i[brick_regs_pkg::Pic8259Ocw2RotateLsb];
  assign ocw2_specific = wdata_i[brick_regs_pkg::Pic8259Ocw2SlLsb];
  assign ocw2_end      = wdata_i[brick_regs_pkg::Pic8259Ocw2EoiLsb];
  assign ocw2_level    = ocw2_specific ? wdata_i[brick_regs_pkg::Pic8259Ocw2IrLsb +: 3] : level_serviced;

  // Writes; an acknowledge never comes with one. INT is made of `_w`: at an acknowledge it falls whatever is left.
  always_comb begin
    isr_w    = isr_q;
    lowest_w = lowest_q;
    turn_d   = turn_q;
    // A line that is low now arms its next edge, whatever clears it.
    armed_w  = armed_q;
    if (ocw2 && ocw2_end && (ocw2_specific || !rank_serviced[3])) begin
      isr_w = isr_w & ~(8'd1 << ocw2_level);
      if (ocw2_turn) lowest_w = ocw2_level;
    end
    if (ocw2 && !ocw2_end) begin
      if (!ocw2_specific) turn_d = ocw2_turn;
      else if (ocw2_turn) lowest_w = ocw2_level;
    end
    if (icw1) begin
      armed_w  = 8'h00;
      isr_w    = 8'h00;
      lowest_w = DefaultLevel;
      turn_d   = 1'b0;
    end
    armed_w = armed_w | ~line2_q;
  end

  always_comb begin
    armed_d  = armed_w;
    isr_d    = isr_w;
    lowest_d = lowest_w;
    if (ack) begin
      armed_d = armed_w & ~(8'd1 << level_ack);
      if (!aeoi_q) isr_d = isr_w | (8'd1 << level_ack);
      else if (turn_q) lowest_d = level_ack;
    end
  end

  always_comb begin
    imr_d    = imr_q;
    vector_d = vector_q;
    step_d   = step_q;
    aeoi_d   = aeoi_q;
    if (second) begin
      unique case (step_q)
        StepIcw2: begin
          vector_d = wdata_i[brick_regs_pkg::Pic8259Icw2VectorLsb +: 5];
          step_d   = icw3_q ? StepIcw3 : (icw4_q ? StepIcw4 : StepReady);
        end
        StepIcw3: step_d = icw4_q ? StepIcw4 : StepReady;
        StepIcw4: begin
          aeoi_d = wdata_i[brick_regs_pkg::Pic8259Icw4AeoiLsb];
          step_d = StepReady;
        end
        default: imr_d = wdata_i;
      endcase
    end
    if (icw1) begin
      imr_d  = 8'h00;
      aeoi_d = 1'b0;
      step_d = StepIcw2;
    end
  end

  always_comb begin
    level_d    = icw1 ? wdata_i[brick_regs_pkg::Pic8259Icw1LtimLsb] : level_q;
    icw3_d     = icw1 ? ~wdata_i[brick_regs_pkg::Pic8259Icw1SnglLsb] : icw3_q;
    icw4_d     = icw1 ? wdata_i[brick_regs_pkg::Pic8259Icw1Ic4Lsb] : icw4_q;
    special_d  = special_q;
    read_isr_d = read_isr_q;
    poll_d     = poll_q & ~rd_poll;
    if (ocw3) begin
      if (wdata_i[brick_regs_pkg::Pic8259Ocw3EsmmLsb]) special_d = wdata_i[brick_regs_pkg::Pic8259Ocw3SmmLsb];
      if (wdata_i[brick_regs_pkg::Pic8259Ocw3RrLsb])   read_isr_d = wdata_i[brick_regs_pkg::Pic8259Ocw3RisLsb];
      poll_d = wdata_i[brick_regs_pkg::Pic8259Ocw3PollLsb];
    end
    if (icw1) begin
      special_d  = 1'b0;
      read_isr_d = 1'b0;
      poll_d     = 1'b0;
    end
  end

  // Reset as if all lines were high: none is armed before it has been seen low.
  sync2 #(.Width(8), .Reset(8'hFF)) u_line_sync (.clk_i(clk_ref_i), .rst_ni, .d_i(line_i), .q_o(line2_q));

  always_ff @(posedge clk_ref_i or negedge rst_ni) begin
    if (!rst_ni) begin
      armed_q    <= 8'h00;
      isr_q      <= 8'h00;
      imr_q      <= brick_regs_pkg::Pic8259Ocw1Reset;
      lowest_q   <= DefaultLevel;
      vector_q   <= 5'h00;
      step_q     <= StepReady;
      icw3_q     <= 1'b0;
      icw4_q     <= 1'b0;
      level_q    <= 1'b0;
      aeoi_q     <= 1'b0;
      turn_q     <= 1'b0;
      special_q  <= 1'b0;
      read_isr_q <= 1'b0;
      poll_q     <= 1'b0;
    end else begin
      armed_q    <= armed_d;
      isr_q      <= isr_d;
      imr_q      <= imr_d;
      lowest_q   <= lowest_d;
      vector_q   <= vector_d;
      step_q     <= step_d;
      icw3_q     <= icw3_d;
      icw4_q     <= icw4_d;
      level_q    <= level_d;
      aeoi_q     <= aeoi_d;
      turn_q     <= turn_d;
      special_q  <= special_d;
      read_isr_q <= read_isr_d;
      poll_q     <= poll_d;
    end
  end

  always_comb begin
    rdata_o = 8'h00;
    unique case (addr_i)
      Command: rdata_o = read_isr_q ? isr_q : irr;
      Second:  rdata_o = imr_q;
      Acknowledge: begin
        rdata_o[brick_regs_pkg::Pic8259VectorBaseLsb +: 5] = vector_q;
        rdata_o[brick_regs_pkg::Pic8259VectorIrLsb +: 3]   = level_ack;
      end
      default: rdata_o = 8'hFF;
    endcase
    if (poll_q && !addr_i[1]) begin
      rdata_o                                       = 8'h00;
      rdata_o[brick_regs_pkg::Pic8259PollPendingLsb] = pending;
      rdata_o[brick_regs_pkg::Pic8259PollIrLsb +: 3] = level_ack;
    end
  end

  assign irr_o   = irr;
  assign isr_o   = isr_q;
  assign imr_o   = imr_q;
  assign level_o = level_q;

  // INT is made of what a write leaves in the registers: what it masks or ends asks no more. A line goes a clock later.
  // Without the read, whose strobe comes from clk_pwm and has no time for two ranks; `served_o` stands for it.
  logic [7:0] asks, holds;
  assign asks      = line2_q & (armed_w | {8{level_d}}) & ~imr_d;
  assign holds     = isr_w & ~(imr_d & {8{special_d}});
  assign request_o = (step_d == StepReady) & (rank(asks, lowest_w) < rank(holds, lowest_w));
  assign served_o  = ack;

endmodule : pic_8259

`default_nettype wire
