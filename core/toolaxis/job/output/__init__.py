"""What is made of a plan: verdict, programs, exports, pages and pictures."""
