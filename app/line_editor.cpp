#include "app/line_editor.h"

#include <histedit.h>
#include <poll.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <exception>
#include <fstream>
#include <string_view>
#include <utility>

#include <fmt/format.h>

#include "systemc/core/input_file.h"

namespace brick {

namespace {
constexpr int kHistoryLines = 1000;
constexpr unsigned char kBell = 0x07, kFirstOther = 0x80;
constexpr std::string_view kHistoryMark = "_HiStOrY_V2_";  // libedit's, first line of the file
constexpr std::string_view kOfController = "ABCDEFGKLNOPQRSTUVWXYZ";
}  // namespace

// libedit is C: what the caller's functions throw is kept, ends the line, and is thrown again outside of it.
struct LineEditor::Impl {
  Impl(LineEditor& editor, std::string text) : owner(editor), prompt(std::move(text)) {
    HistEvent event;
    history(past, &event, H_SETSIZE, kHistoryLines);
    history(past, &event, H_SETUNIQUE, 1);
    el_set(edit, EL_CLIENTDATA, this);
    el_set(edit, EL_EDITOR, "emacs");
    el_set(edit, EL_PROMPT, &Impl::show_prompt);
    el_set(edit, EL_HIST, history, past);
    el_set(edit, EL_GETCFN, &Impl::next_key);
    el_set(edit, EL_SETTY, "-d", "-isig", "-ixon", "-iexten", nullptr);  // ^C ^S ^Q ^V are keys like others
    el_set(edit, EL_SETTY, "-x", "+noflsh", nullptr);  // while a command runs: ^C takes no text away that is under way
    el_set(edit, EL_ADDFN, "controller-key", "send the control character to the controller", &Impl::control_key);
    el_set(edit, EL_ADDFN, "leave", "end the session", &Impl::leave_key);
    for (const char letter : kOfController)
      el_set(edit, EL_BIND, fmt::format("^{}", letter).c_str(), "controller-key", nullptr);
    el_set(edit, EL_BIND, "^]", "leave", nullptr);
    for (const auto& [key, action] : std::array<std::pair<const char*, const char*>, 3>{
             {{"\033[3~", "ed-delete-next-char"}, {"\033[1~", "ed-move-to-beg"}, {"\033[4~", "ed-move-to-end"}}})
      el_set(edit, EL_BIND, key, action, nullptr);
  }
  ~Impl() {
    el_end(edit);
    history_end(past);
  }
  Impl(const Impl&) = delete;
  Impl& operator=(const Impl&) = delete;

  static Impl& of(EditLine* edit) {
    void* self = nullptr;
    el_get(edit, EL_CLIENTDATA, &self);
    return *static_cast<Impl*>(self);
  }
  static char* show_prompt(EditLine* edit) { return of(edit).prompt.data(); }
  static int next_key(EditLine* edit, wchar_t* key) { return of(edit).next(key); }
  static unsigned char control_key(EditLine* edit, int key) { return of(edit).control(key); }
  static unsigned char leave_key(EditLine* edit, int) {
    of(edit).left = true;
    return CC_EOF;
  }

  template <class Function>
  bool call(const Function& function) {
    try {
      function();
    } catch (...) { thrown = std::current_exception(); }
    return !thrown;
  }

  // 1 = a key, 0 = the end. Keys that are no ASCII mean nothing to the controller.
  int next(wchar_t* key) {
    std::chrono::milliseconds pause{0};
    for (;;) {
      pollfd keys{STDIN_FILENO, POLLIN, 0};
      if (poll(&keys, 1, static_cast<int>(pause.count())) <= 0) {
        if (!call([&] { pause = owner.while_waiting(); })) return 0;
        redraw();
        continue;
      }
      unsigned char byte = 0;
      if (::read(STDIN_FILENO, &byte, 1) != 1) return 0;
      if (byte < kFirstOther) {
        *key = byte;
        return 1;
      }
      std::fputc(kBell, stdout);
      std::fflush(stdout);
    }
  }

  unsigned char control(int key) {
    const bool alive = call([&] { owner.on_control(static_cast<char>(key)); });
    redraw();
    return alive ? CC_NORM : CC_EOF;
  }

  void redraw() {
    if (std::exchange(cleared, false)) el_set(edit, EL_REFRESH);
  }

  LineEditor& owner;
  std::string prompt;
  History* past = history_init();
  EditLine* edit = el_init("brick", stdin, stdout, stderr);
  std::exception_ptr thrown;
  bool reading = false, left = false, cleared = false;
};

LineEditor::LineEditor(const std::string& prompt) : impl_(std::make_unique<Impl>(*this, prompt)) {}
LineEditor::~LineEditor() = default;

std::optional<std::string> LineEditor::read() {
  int count = 0;
  impl_->reading = true;
  const char* text = el_gets(impl_->edit, &count);
  impl_->reading = false;
  if (impl_->thrown) std::rethrow_exception(std::exchange(impl_->thrown, nullptr));
  if (text == nullptr || count <= 0 || impl_->left) return std::nullopt;
  std::string line(text, static_cast<std::size_t>(count));
  while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.pop_back();
  HistEvent event;
  if (!line.empty()) history(impl_->past, &event, H_ENTER, line.c_str());
  return line;
}

void LineEditor::make_room() {
  if (!impl_->reading || std::exchange(impl_->cleared, true)) return;
  std::fputs("\r\033[J", stdout);
  std::fflush(stdout);
}

bool LineEditor::may_be_history(const std::string& file) {
  if (is_named_pipe(file)) return false;
  std::ifstream in(file);
  std::string first;
  return !std::getline(in, first) || first == kHistoryMark;
}

void LineEditor::load_history(const std::string& file) {
  HistEvent event;
  history(impl_->past, &event, H_LOAD, file.c_str());
}

bool LineEditor::save_history(const std::string& file) const {
  HistEvent event;
  return history(impl_->past, &event, H_SAVE, file.c_str()) >= 0;
}

}  // namespace brick
