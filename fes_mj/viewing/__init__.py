"""What people look at: video, interactive viewer, drawings."""
