# tests of tled
