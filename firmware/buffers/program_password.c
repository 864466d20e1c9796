#include "firmware/buffers/program_password.h"

enum { FIRST_PROTECTED_PROG = 1000, PROTECTED_PLCS = 16 };

static struct {
  char text[PASSWORD_LENGTH];
  uint32_t length;
  bool entered;
} password;

static void set(const char* text, uint32_t length) {
  password.length = length;
  __builtin_memcpy(password.text, text, password.length);
}

void program_password_initialize(void) {
  password.length = 0;
  password.entered = true;
}

error_t program_password_enter(const char* text, uint32_t length) {
  if (password.entered) {
    if (length > PASSWORD_LENGTH) return ERR_DATA;
    set(text, length);
    return ERR_NONE;
  }
  if (length != password.length || __builtin_memcmp(text, password.text, length) != 0) return ERR_PASSWORD;
  password.entered = true;
  return ERR_NONE;
}

bool program_password_protects(enum fixed_kind kind, uint32_t number) {
  if (password.entered) return false;
  if (kind == FIXED_PROG) return number >= FIRST_PROTECTED_PROG;
  return kind != FIXED_PLC || number < PROTECTED_PLCS;
}

uint32_t program_password(const char** text) {
  *text = password.text;
  return password.length;
}

void program_password_restore(const char* text, uint32_t length) {
  set(text, length);
  password.entered = password.length == 0;
}
