"""What a joint's friction may lack, what that is worth to first order, and fits of what is worth one."""
